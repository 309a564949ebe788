"""What pairs, stiffnesses, modifications and searches are made of, as a study states them.

Numbers are in SI: metres, radians, newtons, pascals. A quantity may also be a text with its unit, ``"12 um"``, or a quantity
of pint. Where ``Floats`` stands, an array has one element for each design of a call that takes many.

Written by python/generate from the program's own declarations; changes are made there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Mapping, Protocol, Sequence, Union

from gearstudy import _gearstudy

if TYPE_CHECKING:
    import numpy
    import numpy.typing

__all__ = [
    "AllowanceToothThickness",
    "ArcRelief",
    "ArcRoot",
    "CentreDistanceAllowance",
    "ChamferTip",
    "Declared",
    "DifferentialEvolution",
    "EndRelief",
    "Energy",
    "FiniteElement",
    "Floats",
    "GearSpecification",
    "Genetic",
    "Grid",
    "HasUnits",
    "HelixSlope",
    "Iso6336",
    "IsoAmount",
    "LandTip",
    "LatinHypercube",
    "LeadCrowning",
    "Material",
    "MeasuredRelief",
    "MeasuredWith",
    "Modification",
    "NelderMead",
    "Nsga2",
    "OptimisedArcRoot",
    "OverBallsToothThickness",
    "Pair",
    "ParabolaRelief",
    "PinionCutter",
    "Powell",
    "ProfileCrowning",
    "ProfileSlope",
    "Quantity",
    "Rack",
    "RootRelief",
    "RoundingTip",
    "Search",
    "SemiToppingTip",
    "Sobol",
    "SpanToothThickness",
    "Stiffness",
    "TangentArcRoot",
    "TipRelief",
    "TrochoidRoot",
    "WeberBanaschek",
]


class HasUnits(Protocol):
    """A quantity of pint."""

    @property
    def magnitude(self) -> Any: ...

    @property
    def dimensionality(self) -> Any: ...

    def to(self, unit: str) -> Any: ...


Quantity = Union[float, str, HasUnits]
Floats = Union[Quantity, Sequence[float], "numpy.typing.NDArray[numpy.floating[Any]]"]


class Declared:
    """Something that a study states: its name among its family, and its fields."""

    name: str | None = None
    fields: dict[str, Any]

    def __init__(self, **fields: Any) -> None:
        stated = {name: value for name, value in fields.items() if value is not None}
        self.__dict__.update(fields=stated, _known=frozenset(fields))

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """What was stated as the field of this name; None where nothing was."""
            if name in self.__dict__.get("_known", ()):
                return self.fields.get(name)
            raise AttributeError(f"{type(self).__name__} has no {name!r}")

        def __setattr__(self, name: str, value: Any) -> None:
            raise AttributeError(f"{type(self).__name__} does not change; make another one")

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={value!r}" for name, value in self.fields.items())
        return f"{type(self).__name__}({inside})"

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other) or not isinstance(other, Declared):
            return False
        own, others = self.fields, other.fields
        return own.keys() == others.keys() and all(_equal(own[name], others[name]) for name in own)

    __hash__ = None  # type: ignore[assignment]


def _equal(one: Any, other: Any) -> bool:
    if getattr(one, "shape", ()) != getattr(other, "shape", ()):
        return False
    found = one == other
    return bool(found.all() if hasattr(found, "all") else found)


class Modification(Declared):
    """A modification of a tooth flank."""


class IsoAmount(Declared):
    """Instead of `amount`: Δ_max = K_A F_t / (b ε_α c_γ).

    Parameters
    ----------
    application_factor : number, optional
        K_A. 0.1 to 10. Without it: 1.
    tangential_load : number [N]
        F_t: nominal tangential load. 0 to 1e+09 N.
    face_width : number [m], optional
        b; the narrower gear's when left out. 0.0001 to 10 m.
    contact_ratio : number, optional
        ε_α; the pair's when left out. 1 to 6.
    mesh_stiffness : number [Pa]
        c_γ: mesh stiffness per face width. 1e+06 to 1e+13 Pa.
    """

    def __init__(
        self,
        *,
        tangential_load: Quantity,
        mesh_stiffness: Quantity,
        application_factor: float | None = None,
        face_width: Quantity | None = None,
        contact_ratio: float | None = None,
    ) -> None:
        super().__init__(
            application_factor=application_factor,
            tangential_load=tangential_load,
            face_width=face_width,
            contact_ratio=contact_ratio,
            mesh_stiffness=mesh_stiffness,
        )


class TipRelief(Modification):
    """C_αa: relief that grows from a start on the flank to the tip.

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    amount : number [m], or an array of shape (designs,), optional
        Depth at the end of the relief, normal to the flank. 0 to 0.005 m.
    iso_amount : IsoAmount | Mapping[str, Any], optional
        Instead of `amount`: Δ_max = K_A F_t / (b ε_α c_γ).
    length : number [m], or an array of shape (designs,), optional
        L: roll length of the relief along the line of action; a relief of no length removes nothing. 0 to 1 m.
    fraction : number, or an array of shape (designs,), optional
        Instead of `length`: length over p_b(ε_α − 1); 1 is long relief, 0.5 short relief. 0 to 10.
    start_roll_angle : number [rad], or an array of shape (designs,), optional
        Instead of `length`: roll angle where the relief starts. 0 to 10 rad.
    start_diameter : number [m], or an array of shape (designs,), optional
        Instead of `length`: diameter at which the relief starts. 0.0001 to 100 m.
    counted_from : Literal["tip", "single_zone", "zone_end"], optional
        Where `length` or `fraction` counts from. Without it: tip.
    curve : Literal["linear", "parabolic", "power"], optional
        How the depth grows over the relief, with t from 0 at its start to 1 at its end. Without it: linear.
    exponent : number, or an array of shape (designs,), optional
        n of the curve `power`: 1 is linear, 2 has no kink at the start. 0.5 to 10.

    >>> Design(pair, TipRelief(gear="both", amount=14e-6, fraction=0.8)).resolved[0][1]
    'tip_relief'
    """

    name = "tip_relief"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        amount: Floats | None = None,
        iso_amount: IsoAmount | Mapping[str, Any] | None = None,
        length: Floats | None = None,
        fraction: Floats | None = None,
        start_roll_angle: Floats | None = None,
        start_diameter: Floats | None = None,
        counted_from: Literal["tip", "single_zone", "zone_end"] | None = None,
        curve: Literal["linear", "parabolic", "power"] | None = None,
        exponent: Floats | None = None,
    ) -> None:
        super().__init__(
            gear=gear,
            amount=amount,
            iso_amount=iso_amount,
            length=length,
            fraction=fraction,
            start_roll_angle=start_roll_angle,
            start_diameter=start_diameter,
            counted_from=counted_from,
            curve=curve,
            exponent=exponent,
        )


class RootRelief(Modification):
    """C_αf: relief that grows from a start on the flank to the root end of its active part.

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    amount : number [m], or an array of shape (designs,), optional
        Depth at the end of the relief, normal to the flank. 0 to 0.005 m.
    iso_amount : IsoAmount | Mapping[str, Any], optional
        Instead of `amount`: Δ_max = K_A F_t / (b ε_α c_γ).
    length : number [m], or an array of shape (designs,), optional
        L: roll length of the relief along the line of action; a relief of no length removes nothing. 0 to 1 m.
    fraction : number, or an array of shape (designs,), optional
        Instead of `length`: length over p_b(ε_α − 1); 1 is long relief, 0.5 short relief. 0 to 10.
    start_roll_angle : number [rad], or an array of shape (designs,), optional
        Instead of `length`: roll angle where the relief starts. 0 to 10 rad.
    start_diameter : number [m], or an array of shape (designs,), optional
        Instead of `length`: diameter at which the relief starts. 0.0001 to 100 m.
    counted_from : Literal["root", "single_zone", "zone_end"], optional
        Where `length` or `fraction` counts from. Without it: root.
    curve : Literal["linear", "parabolic", "power"], optional
        How the depth grows over the relief, with t from 0 at its start to 1 at its end. Without it: linear.
    exponent : number, or an array of shape (designs,), optional
        n of the curve `power`: 1 is linear, 2 has no kink at the start. 0.5 to 10.

    >>> Design(pair, RootRelief(gear="pinion", amount="8 um", length="2 mm", curve="parabolic")).resolved[0][1]
    'root_relief'
    """

    name = "root_relief"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        amount: Floats | None = None,
        iso_amount: IsoAmount | Mapping[str, Any] | None = None,
        length: Floats | None = None,
        fraction: Floats | None = None,
        start_roll_angle: Floats | None = None,
        start_diameter: Floats | None = None,
        counted_from: Literal["root", "single_zone", "zone_end"] | None = None,
        curve: Literal["linear", "parabolic", "power"] | None = None,
        exponent: Floats | None = None,
    ) -> None:
        super().__init__(
            gear=gear,
            amount=amount,
            iso_amount=iso_amount,
            length=length,
            fraction=fraction,
            start_roll_angle=start_roll_angle,
            start_diameter=start_diameter,
            counted_from=counted_from,
            curve=curve,
            exponent=exponent,
        )


class ArcRelief(Modification):
    """Circular arc that leaves the flank along its tangent and ends inside the tip corner (mei2016).

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    tip_share : number, or an array of shape (designs,), optional
        How far A is moved from the corner inwards along the tip circle, as a share of the tip thickness s_a. 0 to
        0.5.
    tip_amount : number [m], or an array of shape (designs,), optional
        Instead of `tip_share`: the same as a length along the tip circle. 0 to 0.005 m.
    length_share : number, or an array of shape (designs,), optional
        How far B is from the tip, as a share of the arc length of the whole involute, from the form circle to the
        tip. 0 to 1.
    start_diameter : number [m], or an array of shape (designs,), optional
        Instead of `length_share`: diameter at which B lies. 0.0001 to 100 m.
    formulas : Literal["derived", "printed"], optional
        Which formulas give the curve. Without it: derived.

    >>> Design(pair, ArcRelief(gear="both", tip_share=0.1, length_share=0.3)).resolved[0][1]
    'arc'
    """

    name = "arc"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        tip_share: Floats | None = None,
        tip_amount: Floats | None = None,
        length_share: Floats | None = None,
        start_diameter: Floats | None = None,
        formulas: Literal["derived", "printed"] | None = None,
    ) -> None:
        super().__init__(
            gear=gear,
            tip_share=tip_share,
            tip_amount=tip_amount,
            length_share=length_share,
            start_diameter=start_diameter,
            formulas=formulas,
        )


class ParabolaRelief(Modification):
    """Parabola that leaves the flank along its tangent and ends inside the tip corner (mei2016).

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    tip_share : number, or an array of shape (designs,), optional
        How far A is moved from the corner inwards along the tip circle, as a share of the tip thickness s_a. 0 to
        0.5.
    tip_amount : number [m], or an array of shape (designs,), optional
        Instead of `tip_share`: the same as a length along the tip circle. 0 to 0.005 m.
    length_share : number, or an array of shape (designs,), optional
        How far B is from the tip, as a share of the arc length of the whole involute, from the form circle to the
        tip. 0 to 1.
    start_diameter : number [m], or an array of shape (designs,), optional
        Instead of `length_share`: diameter at which B lies. 0.0001 to 100 m.
    formulas : Literal["derived", "printed"], optional
        Which formulas give the curve. Without it: derived.

    >>> Design(pair, ParabolaRelief(gear="both", tip_share=0.1, length_share=0.3)).resolved[0][1]
    'parabola'
    """

    name = "parabola"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        tip_share: Floats | None = None,
        tip_amount: Floats | None = None,
        length_share: Floats | None = None,
        start_diameter: Floats | None = None,
        formulas: Literal["derived", "printed"] | None = None,
    ) -> None:
        super().__init__(
            gear=gear,
            tip_share=tip_share,
            tip_amount=tip_amount,
            length_share=length_share,
            start_diameter=start_diameter,
            formulas=formulas,
        )


class ProfileCrowning(Modification):
    """C_α: parabola over the roll length of the active flank, nothing in its middle.

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    amount : number [m], or an array of shape (designs,)
        C_α: depth at both ends of the active flank. 0 to 0.005 m.

    >>> Design(pair, ProfileCrowning(gear="pinion", amount=5e-6)).resolved[0][1]
    'profile_crowning'
    """

    name = "profile_crowning"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        amount: Floats,
    ) -> None:
        super().__init__(
            gear=gear,
            amount=amount,
        )


class ProfileSlope(Modification):
    """C_Hα: straight line over the roll length of the active flank.

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    amount : number [m], or an array of shape (designs,)
        C_Hα: positive takes material off at the tip, negative at the root end; the other end keeps it. -0.005 to
        0.005 m.

    >>> Design(pair, ProfileSlope(gear="gear", amount=-3e-6)).resolved[0][1]
    'profile_slope'
    """

    name = "profile_slope"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        amount: Floats,
    ) -> None:
        super().__init__(
            gear=gear,
            amount=amount,
        )


class LeadCrowning(Modification):
    """C_β: parabola C_β(2z/b)² across the gear's own face width.

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    amount : number [m], or an array of shape (designs,)
        C_β: depth at both ends of the gear's own face. 0 to 0.005 m.

    >>> Design(pair, LeadCrowning(gear="pinion", amount=6e-6)).resolved[0][1]
    'lead_crowning'
    """

    name = "lead_crowning"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        amount: Floats,
    ) -> None:
        super().__init__(
            gear=gear,
            amount=amount,
        )


class HelixSlope(Modification):
    """C_Hβ: straight line across the gear's own face width; also stands for a misalignment.

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    amount : number [m], or an array of shape (designs,)
        C_Hβ over the face width: positive takes material off at z = +b/2, negative at z = −b/2; the other end
        keeps it. -0.005 to 0.005 m.

    >>> Design(pair, HelixSlope(gear="gear", amount=10e-6)).resolved[0][1]
    'helix_slope'
    """

    name = "helix_slope"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        amount: Floats,
    ) -> None:
        super().__init__(
            gear=gear,
            amount=amount,
        )


class EndRelief(Modification):
    """C_βI, C_βII: relief that grows from a start on the face to one or both of its ends.

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    amount : number [m], or an array of shape (designs,)
        C_βI, C_βII: depth at the end of the gear's own face. 0 to 0.005 m.
    length : number [m], or an array of shape (designs,)
        L_CβI, L_CβII: how far from the end of the face the relief starts; at most the face width for one end, half
        of it for both; a relief of no length removes nothing. 0 to 10 m.
    end : Literal["I", "II", "both"], optional
        Which end of the face is relieved; two of them with different values are two entries. Without it: both.
    curve : Literal["linear", "parabolic", "power"], optional
        How the depth grows over the relief, with t from 0 at its start to 1 at its end. Without it: linear.
    exponent : number, or an array of shape (designs,), optional
        n of the curve `power`: 1 is linear, 2 has no kink at the start. 0.5 to 10.

    >>> Design(pair, EndRelief(gear="pinion", amount=10e-6, length=4e-3)).resolved[0][1]
    'end_relief'
    """

    name = "end_relief"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        amount: Floats,
        length: Floats,
        end: Literal["I", "II", "both"] | None = None,
        curve: Literal["linear", "parabolic", "power"] | None = None,
        exponent: Floats | None = None,
    ) -> None:
        super().__init__(
            gear=gear,
            amount=amount,
            length=length,
            end=end,
            curve=curve,
            exponent=exponent,
        )


class MeasuredRelief(Modification):
    """Flank as measured: deviations (ISO 1328-1) along the profile, across the face, or over both.

    Parameters
    ----------
    gear : Literal["pinion", "gear", "both"]
        Which gear is modified.
    roll_lengths : Sequence[Quantity], optional
        L_y: roll lengths of the points along the profile, r_b times the roll angle, from the root to the tip.
    roll_angles : Sequence[Quantity], optional
        Instead of `roll_lengths`: roll angles of the points along the profile.
    diameters : Sequence[Quantity], optional
        Instead of `roll_lengths`: diameters of the points along the profile.
    face_positions : Sequence[Quantity], optional
        z of the points across the face, from its middle; with points along the profile too, the deviations are
        those of a grid.
    deviations : Sequence[Quantity]
        Deviations normal to the flank, positive where there is more material than designed, in the order of the
        points; of a grid all along the profile for each place across the face.
    evaluation_start : number [m], optional
        Roll length, or z of a trace across the face, from which the trace is evaluated; the start of the active
        flank, or the end of the face, when left out. -10 to 10 m.
    evaluation_end : number [m], optional
        Up to which it is evaluated; the tip, or the other end of the face, when left out. -10 to 10 m.
    evaluation_start_diameter : number [m], optional
        Instead of `evaluation_start`: diameter from which a trace along the profile is evaluated. 0.0001 to 100 m.
    evaluation_end_diameter : number [m], optional
        Instead of `evaluation_end`: diameter up to which it is evaluated, such as the tip form circle's. 0.0001 to
        100 m.
    teeth : int, optional
        z: number of teeth of the gear that was measured; another gear is refused. 4 to 10000.
    module : number [m], optional
        m: module of the gear that was measured; another gear is refused. 1e-05 to 1 m.
    smoothing : Literal["none", "gaussian"], optional
        What is left out of a trace before it is a flank. Without it: none.
    cutoff : number [m], optional
        λ: wavelength of which half is left, along the roll length or across the face; ISO 1328-1 has λ_α = L_α/30.
        1e-06 to 1 m.

    >>> Design(pair, MeasuredRelief(gear="pinion", face_positions=[-9e-3, 0.0, 9e-3], deviations=["-2 um", "1 um", "-3 um"])).resolved[0][1]
    'measured'
    """

    name = "measured"

    def __init__(
        self,
        *,
        gear: Literal["pinion", "gear", "both"],
        deviations: Sequence[Quantity],
        roll_lengths: Sequence[Quantity] | None = None,
        roll_angles: Sequence[Quantity] | None = None,
        diameters: Sequence[Quantity] | None = None,
        face_positions: Sequence[Quantity] | None = None,
        evaluation_start: Quantity | None = None,
        evaluation_end: Quantity | None = None,
        evaluation_start_diameter: Quantity | None = None,
        evaluation_end_diameter: Quantity | None = None,
        teeth: int | None = None,
        module: Quantity | None = None,
        smoothing: Literal["none", "gaussian"] | None = None,
        cutoff: Quantity | None = None,
    ) -> None:
        super().__init__(
            gear=gear,
            roll_lengths=roll_lengths,
            roll_angles=roll_angles,
            diameters=diameters,
            face_positions=face_positions,
            deviations=deviations,
            evaluation_start=evaluation_start,
            evaluation_end=evaluation_end,
            evaluation_start_diameter=evaluation_start_diameter,
            evaluation_end_diameter=evaluation_end_diameter,
            teeth=teeth,
            module=module,
            smoothing=smoothing,
            cutoff=cutoff,
        )


class Search(Declared):
    """A method of an `Optimizer`."""


class Genetic(Search):
    """Genetic algorithm on binary chromosomes.

    Parameters
    ----------
    population : int, optional
        Individuals per generation. 2 to 100000. Without it: 100.
    generations : int, optional
        Generations, the first random one included. 1 to 1e+06. Without it: 100.
    bits : int, optional
        Bits per variable: its range in 2^bits values, bounds included. 1 to 32. Without it: 10.
    coding : Literal["binary", "gray"], optional
        How bits stand for a number. Without it: binary.
    selection : Literal["roulette", "tournament"], optional
        How parents are chosen. Without it: roulette.
    crossover : number, optional
        Probability that two parents exchange what follows a random cut. 0 to 1. Without it: 0.5.
    mutation : number, optional
        Probability of a mutation. 0 to 1. Without it: 0.5.
    mutation_of : Literal["offspring", "bit"], optional
        What the probability of a mutation is of. Without it: offspring.
    elite : int, optional
        Best individuals that live on unchanged. 0 to 100000. Without it: 0.
    converged_after : int, optional
        Ends after this many generations without improvement. 1 to 1e+06.
    least_improvement : number, optional
        Share of the best value below which a gain is not an improvement. 0 to 1. Without it: 0.

    >>> Optimizer(Genetic(), [(0, 1), (2, 5)]).ask().shape[1]
    2
    """

    name = "genetic"

    def __init__(
        self,
        *,
        population: int | None = None,
        generations: int | None = None,
        bits: int | None = None,
        coding: Literal["binary", "gray"] | None = None,
        selection: Literal["roulette", "tournament"] | None = None,
        crossover: float | None = None,
        mutation: float | None = None,
        mutation_of: Literal["offspring", "bit"] | None = None,
        elite: int | None = None,
        converged_after: int | None = None,
        least_improvement: float | None = None,
    ) -> None:
        super().__init__(
            population=population,
            generations=generations,
            bits=bits,
            coding=coding,
            selection=selection,
            crossover=crossover,
            mutation=mutation,
            mutation_of=mutation_of,
            elite=elite,
            converged_after=converged_after,
            least_improvement=least_improvement,
        )


class DifferentialEvolution(Search):
    """Global search by differences within a population.

    Parameters
    ----------
    population : int, optional
        Individuals per generation; ten per variable is usual. 4 to 100000. Without it: 60.
    generations : int, optional
        Most generations, the first one included. 1 to 1e+06. Without it: 200.
    mutant : Literal["rand", "current_to_best"], optional
        How a mutant is made. Without it: rand.
    weight : number, optional
        F, the weight of a difference. 0 to 2. Without it: 0.7.
    crossover : number, optional
        CR, the probability that a variable is taken from the mutant. 0 to 1. Without it: 0.9.
    tolerance : number, optional
        Spread of the values, as a share of the best, at which it has converged. 0 to 1. Without it: 1e-8.
    polish : Literal["none", "nelder_mead"], optional
        Local search from the best individual. Without it: none.
    polish_evaluations : int, optional
        Most evaluations of the local search. 10 to 1e+07. Without it: 2000.

    >>> Optimizer(DifferentialEvolution(), [(0, 1), (2, 5)]).ask().shape[1]
    2
    """

    name = "differential_evolution"

    def __init__(
        self,
        *,
        population: int | None = None,
        generations: int | None = None,
        mutant: Literal["rand", "current_to_best"] | None = None,
        weight: float | None = None,
        crossover: float | None = None,
        tolerance: float | None = None,
        polish: Literal["none", "nelder_mead"] | None = None,
        polish_evaluations: int | None = None,
    ) -> None:
        super().__init__(
            population=population,
            generations=generations,
            mutant=mutant,
            weight=weight,
            crossover=crossover,
            tolerance=tolerance,
            polish=polish,
            polish_evaluations=polish_evaluations,
        )


class NelderMead(Search):
    """Local search by a moving simplex, without derivatives.

    Parameters
    ----------
    start : Literal["centre", "random"], optional
        Where it starts. Without it: centre.
    edge : number, optional
        Edge of the first simplex, as a share of each range. 1e-06 to 1. Without it: 0.1.
    tolerance : number, optional
        The simplex's extent, as a share of each range, at which it has converged. 1e-14 to 0.1. Without it: 1e-8.
    restarts : int, optional
        Most restarts around the best point, or along a kink; with 0 it is not checked. 0 to 1000. Without it: 30.
    evaluations : int, optional
        Most evaluations. 10 to 1e+07. Without it: 5000.

    >>> Optimizer(NelderMead(), [(0, 1), (2, 5)]).ask().shape[1]
    2
    """

    name = "nelder_mead"

    def __init__(
        self,
        *,
        start: Literal["centre", "random"] | None = None,
        edge: float | None = None,
        tolerance: float | None = None,
        restarts: int | None = None,
        evaluations: int | None = None,
    ) -> None:
        super().__init__(
            start=start,
            edge=edge,
            tolerance=tolerance,
            restarts=restarts,
            evaluations=evaluations,
        )


class Powell(Search):
    """Local search along directions that become conjugate, without derivatives.

    Parameters
    ----------
    start : Literal["centre", "random"], optional
        Where it starts. Without it: centre.
    step : number, optional
        First step along each axis, as a share of each range. 1e-06 to 1. Without it: 0.1.
    tolerance : number, optional
        a cycle's way, as a share of each range, at which it has converged. 1e-12 to 0.1. Without it: 1e-8.
    restarts : int, optional
        Most restarts around the best point, along the axes or a kink; with 0 it is not checked. 0 to 1000. Without
        it: 30.
    evaluations : int, optional
        Most evaluations. 10 to 1e+07. Without it: 5000.

    >>> Optimizer(Powell(), [(0, 1), (2, 5)]).ask().shape[1]
    2
    """

    name = "powell"

    def __init__(
        self,
        *,
        start: Literal["centre", "random"] | None = None,
        step: float | None = None,
        tolerance: float | None = None,
        restarts: int | None = None,
        evaluations: int | None = None,
    ) -> None:
        super().__init__(
            start=start,
            step=step,
            tolerance=tolerance,
            restarts=restarts,
            evaluations=evaluations,
        )


class Nsga2(Search):
    """Evolution towards the front of several objectives.

    Parameters
    ----------
    population : int, optional
        Individuals per generation. 4 to 10000. Without it: 100.
    generations : int, optional
        Generations, the first one included. 1 to 1e+06. Without it: 200.
    crossover : number, optional
        Probability that two parents are crossed. 0 to 1. Without it: 0.9.
    crossover_index : number, optional
        Index of the crossover: the larger, the nearer children are to their parents. 0 to 1000. Without it: 15.
    mutation : number, optional
        Probability that a variable mutates; without it one in as many as there are variables. 0 to 1.
    mutation_index : number, optional
        Index of the mutation: the larger, the smaller its steps. 0 to 1000. Without it: 20.

    >>> Optimizer(Nsga2(), [(0, 1), (2, 5)]).ask().shape[1]
    2
    """

    name = "nsga2"

    def __init__(
        self,
        *,
        population: int | None = None,
        generations: int | None = None,
        crossover: float | None = None,
        crossover_index: float | None = None,
        mutation: float | None = None,
        mutation_index: float | None = None,
    ) -> None:
        super().__init__(
            population=population,
            generations=generations,
            crossover=crossover,
            crossover_index=crossover_index,
            mutation=mutation,
            mutation_index=mutation_index,
        )


class Grid(Search):
    """Every combination of equally spaced levels, bounds included.

    Parameters
    ----------
    levels : Sequence[int], optional
        Number of levels: one for all variables, or one for each. Without it: 11.

    >>> Optimizer(Grid(), [(0, 1), (2, 5)]).ask().shape[1]
    2
    """

    name = "grid"

    def __init__(
        self,
        *,
        levels: Sequence[int] | None = None,
    ) -> None:
        super().__init__(
            levels=levels,
        )


class LatinHypercube(Search):
    """Random points, one in each stratum of every variable.

    Parameters
    ----------
    points : int, optional
        Number of points. 1 to 1.67772e+07. Without it: 256.

    >>> Optimizer(LatinHypercube(), [(0, 1), (2, 5)]).ask().shape[1]
    2
    """

    name = "latin_hypercube"

    def __init__(
        self,
        *,
        points: int | None = None,
    ) -> None:
        super().__init__(
            points=points,
        )


class Sobol(Search):
    """Evenly spread points, best when their number is a power of two.

    Parameters
    ----------
    points : int, optional
        Number of points. 1 to 1.67772e+07. Without it: 256.

    >>> Optimizer(Sobol(), [(0, 1), (2, 5)]).ask().shape[1]
    2
    """

    name = "sobol"

    def __init__(
        self,
        *,
        points: int | None = None,
    ) -> None:
        super().__init__(
            points=points,
        )


class AllowanceToothThickness(Declared):
    """Deviations from the thickness without backlash, on the reference circle, as DIN 3967 has them.

    Parameters
    ----------
    upper : number [m]
        Upper allowance A_sns; below 0 for backlash. -0.1 to 0.1 m.
    lower : number [m], optional
        Lower allowance A_sni, when it is another one; the gear is computed in the middle. -0.1 to 0.1 m.

    >>> AllowanceToothThickness(upper=-60e-6, lower=-90e-6).name
    'allowance'
    """

    name = "allowance"

    def __init__(
        self,
        *,
        upper: Quantity,
        lower: Quantity | None = None,
    ) -> None:
        super().__init__(
            upper=upper,
            lower=lower,
        )


class SpanToothThickness(Declared):
    """A span over teeth.

    Parameters
    ----------
    teeth : int
        Number k of teeth in the span. 1 to 10000.
    largest : number [m]
        Span measurement W_k, the largest one. 1e-09 to 1000 m.
    smallest : number [m], optional
        The smallest W_k, when it is another one; the gear is computed in the middle. 1e-09 to 1000 m.

    >>> SpanToothThickness(teeth=3, largest=23.1e-3).name
    'span'
    """

    name = "span"

    def __init__(
        self,
        *,
        teeth: int,
        largest: Quantity,
        smallest: Quantity | None = None,
    ) -> None:
        super().__init__(
            teeth=teeth,
            largest=largest,
            smallest=smallest,
        )


class OverBallsToothThickness(Declared):
    """Two balls or pins in spaces as nearly opposite as there are.

    Parameters
    ----------
    ball_diameter : number [m]
        Diameter D_M of the balls. 1e-09 to 100 m.
    largest : number [m]
        Dimension M_dK over both, the largest one. 1e-09 to 1000 m.
    smallest : number [m], optional
        The smallest M_dK, when it is another one; the gear is computed in the middle. 1e-09 to 1000 m.

    >>> OverBallsToothThickness(ball_diameter=5.25e-3, largest=80.1e-3).name
    'over_balls'
    """

    name = "over_balls"

    def __init__(
        self,
        *,
        ball_diameter: Quantity,
        largest: Quantity,
        smallest: Quantity | None = None,
    ) -> None:
        super().__init__(
            ball_diameter=ball_diameter,
            largest=largest,
            smallest=smallest,
        )


class MeasuredWith(Declared):
    """What its thickness is measured with in `inspection`, when it is not as usual.

    Parameters
    ----------
    span_teeth : int, optional
        k, teeth that a span goes over; when not given those of a `span` that says the thickness, or those whose
        planes touch nearest the V-circle. 1 to 10000.
    ball_diameter : number [m], optional
        D_M, diameter of the balls; when not given that of the balls that say the thickness, or of those that touch
        the V-circle. 1e-06 to 10 m.
    """

    def __init__(
        self,
        *,
        span_teeth: int | None = None,
        ball_diameter: Quantity | None = None,
    ) -> None:
        super().__init__(
            span_teeth=span_teeth,
            ball_diameter=ball_diameter,
        )


class Rack(Declared):
    """Basic rack that cuts this gear, when it is not the common one.

    Parameters
    ----------
    addendum : number, optional
        Addendum coefficient h_aP*. 0.1 to 3. Without it: 1.0.
    dedendum : number, optional
        Dedendum coefficient h_fP*. 0.1 to 4. Without it: 1.25.
    tip_radius : number, optional
        Tip radius coefficient ρ_fP*. 0 to 2. Without it: 0.38.
    protuberance : number, optional
        Protuberance pr*: how far the round of the tip stands out of the straight flank, normal to it. 0 to 0.5.
        Without it: 0.0.
    protuberance_angle : number [rad], optional
        Angle α_prP of the straight side of the protuberance, from the round to the flank; below the pressure
        angle. 0.0174533 to 0.785398 rad. Without it: 10 deg.
    machining_allowance : number, optional
        Machining allowance q*: what the flanks of the tool leave on each flank of the tooth to be ground off. 0 to
        0.5. Without it: 0.0.
    notch_radius : number, optional
        Radius ρ_g* of the notch that grinding leaves in the root, where the allowance is larger than the
        protuberance. 0 to 2. Without it: 0.0.

    >>> gear = GearSpecification(teeth=24, face_width=20e-3, bore_radius=18e-3)
    >>> stub = Pair(module=3e-3, pinion=gear, gear=gear, rack=Rack(addendum=0.8, dedendum=1.05))
    >>> f"{stub.pinion.tip_radius:.5f}"
    '0.03840'
    """

    def __init__(
        self,
        *,
        addendum: float | None = None,
        dedendum: float | None = None,
        tip_radius: float | None = None,
        protuberance: float | None = None,
        protuberance_angle: Quantity | None = None,
        machining_allowance: float | None = None,
        notch_radius: float | None = None,
    ) -> None:
        super().__init__(
            addendum=addendum,
            dedendum=dedendum,
            tip_radius=tip_radius,
            protuberance=protuberance,
            protuberance_angle=protuberance_angle,
            machining_allowance=machining_allowance,
            notch_radius=notch_radius,
        )


class PinionCutter(Declared):
    """Pinion-type cutter that shapes this gear, where no rack cuts it; of the rack its addendum counts then.

    Parameters
    ----------
    teeth : int
        Number of teeth z_0. 4 to 10000.
    profile_shift : number, optional
        Profile shift coefficient x_0: of a new cutter above 0, and smaller each time it is sharpened. -2 to 3.
        Without it: 0.0.
    addendum : number, optional
        Addendum coefficient h_aP0*: its tip radius is m(z_0/2 + x_0 + h_aP0*). 0.1 to 4. Without it: 1.25.
    tip_radius : number, optional
        Radius ρ_aP0* of the rounding of its tips. 0 to 2. Without it: 0.2.
    """

    def __init__(
        self,
        *,
        teeth: int,
        profile_shift: float | None = None,
        addendum: float | None = None,
        tip_radius: float | None = None,
    ) -> None:
        super().__init__(
            teeth=teeth,
            profile_shift=profile_shift,
            addendum=addendum,
            tip_radius=tip_radius,
        )


class TrochoidRoot(Declared):
    """The root curve that the rack generates.

    Parameters
    ----------
    rack_tip : Literal["given", "sharp", "full_round"], optional
        Round of the rack's tip. Without it: given.

    >>> TrochoidRoot().name
    'trochoid'
    """

    name = "trochoid"

    def __init__(
        self,
        *,
        rack_tip: Literal["given", "sharp", "full_round"] | None = None,
    ) -> None:
        super().__init__(
            rack_tip=rack_tip,
        )


class ArcRoot(Declared):
    """Arc from the base circle down by r_b − r_f, as in zhai2020; it need not meet the root circle.

    Parameters
    ----------
    formulas : Literal["derived", "printed"], optional
        Which sign equation 20 has. Without it: derived.

    >>> ArcRoot().name
    'arc'
    """

    name = "arc"

    def __init__(
        self,
        *,
        formulas: Literal["derived", "printed"] | None = None,
    ) -> None:
        super().__init__(
            formulas=formulas,
        )


class TangentArcRoot(Declared):
    """Arc tangent to the root circle and to the flank (or the radial line below the base circle).

    Parameters
    ----------
    size : Literal["base_circle", "largest"], optional
        How large the arc is, where no radius is given. Without it: base_circle.
    radius : number [m], optional
        Radius of the arc. 0 to 100 m.

    >>> TangentArcRoot().name
    'tangent_arc'
    """

    name = "tangent_arc"

    def __init__(
        self,
        *,
        size: Literal["base_circle", "largest"] | None = None,
        radius: Quantity | None = None,
    ) -> None:
        super().__init__(
            size=size,
            radius=radius,
        )


class OptimisedArcRoot(Declared):
    """Arc tangent to the flank on the base circle that comes nearest to the root circle (zhai2020, 27 to 30).

    >>> OptimisedArcRoot().name
    'optimised_arc'
    """

    name = "optimised_arc"



class LandTip(Declared):
    """The flank ends in a corner on the tip circle.

    >>> LandTip().name
    'land'
    """

    name = "land"



class ChamferTip(Declared):
    """A straight chamfer, as high as it is wide.

    Parameters
    ----------
    size : number [m]
        How far it begins below the tip circle. 0 to 1 m.

    >>> ChamferTip(size="0.3 mm").name
    'chamfer'
    """

    name = "chamfer"

    def __init__(
        self,
        *,
        size: Quantity,
    ) -> None:
        super().__init__(
            size=size,
        )


class RoundingTip(Declared):
    """An arc tangent to the flank and to the tip circle.

    Parameters
    ----------
    radius : number [m]
        Radius of the arc. 0 to 1 m.

    >>> RoundingTip(radius="0.3 mm").name
    'rounding'
    """

    name = "rounding"

    def __init__(
        self,
        *,
        radius: Quantity,
    ) -> None:
        super().__init__(
            radius=radius,
        )


class SemiToppingTip(Declared):
    """The chamfer that a semi-topping tool generates with its flank.

    Parameters
    ----------
    angle : number [rad], optional
        Angle α_KP of the tool's ramp; above the pressure angle. 0.08 to 1.4 rad. Without it: 45 deg.
    height : number [m]
        How far below the addendum line of the rack, m h_aP*, the ramp begins. 0 to 1 m.

    >>> SemiToppingTip(height="0.2 mm").name
    'semi_topping'
    """

    name = "semi_topping"

    def __init__(
        self,
        *,
        height: Quantity,
        angle: Quantity | None = None,
    ) -> None:
        super().__init__(
            angle=angle,
            height=height,
        )


class Material(Declared):
    """Material of this gear, when it is not the common one.

    Parameters
    ----------
    youngs_modulus : number [Pa], optional
        Young's modulus E. 1 to 1e+15 Pa. Without it: 206 GPa.
    poisson_ratio : number, optional
        Poisson's ratio ν. 0 to 0.4999. Without it: 0.3.
    density : number [kg/m^3], optional
        Density ρ. 1 to 100000 kg/m^3. Without it: 7830 kg/m^3.

    >>> gear = GearSpecification(teeth=24, face_width=20e-3, bore_radius=18e-3)
    >>> soft = Pair(module=3e-3, pinion=gear, gear=gear, material=Material(youngs_modulus=3e9, poisson_ratio=0.4))
    >>> steel = Pair(module=3e-3, pinion=gear, gear=gear)
    >>> Stiffness(soft).mesh(1.0)[2] < 0.02 * Stiffness(steel).mesh(1.0)[2]
    True
    """

    def __init__(
        self,
        *,
        youngs_modulus: Quantity | None = None,
        poisson_ratio: float | None = None,
        density: Quantity | None = None,
    ) -> None:
        super().__init__(
            youngs_modulus=youngs_modulus,
            poisson_ratio=poisson_ratio,
            density=density,
        )


class GearSpecification(Declared):
    """One of the gears of a pair.

    Parameters
    ----------
    teeth : int
        Number of teeth z. 4 to 10000.
    face_width : number [m]
        Face width b. 1e-06 to 100 m.
    bore_radius : number [m]
        Radius of the bore, where the body is clamped. 0 to 10000 m.
    profile_shift : number, optional
        Profile shift coefficient x. -2 to 3. Without it: 0.0.
    tooth_thickness : Literal["allowance", "span", "over_balls"] | AllowanceToothThickness | SpanToothThickness | OverBallsToothThickness | Mapping[str, Any], optional
        Thickness of the teeth, when it is not that without backlash: profile shift, tip circle and centre distance
        are then nominal.
    tip_radius : number [m], optional
        Tip radius r_a, when it is not m(z/2 + h_aP* + x). 1e-06 to 10000 m.
    tip_shortening : number, optional
        Tip shortening k in modules: r_a = m(z/2 + h_aP* + x − k). -1 to 1.
    from_centre_distance : Literal["profile_shift", "tip_shortening", "both"], optional
        What of this gear is not stated, but follows from the centre distance.
    measured_with : MeasuredWith | Mapping[str, Any], optional
        What its thickness is measured with in `inspection`, when it is not as usual. Without it: the usual one.
    rack : Rack | Mapping[str, Any], optional
        Basic rack that cuts this gear, when it is not the common one.
    pinion_cutter : PinionCutter | Mapping[str, Any], optional
        Pinion-type cutter that shapes this gear, where no rack cuts it; of the rack its addendum counts then.
    root : Literal["trochoid", "arc", "tangent_arc", "optimised_arc"] | TrochoidRoot | ArcRoot | TangentArcRoot | OptimisedArcRoot | Mapping[str, Any], optional
        Root of this gear's teeth in its outline, when it is not the common one.
    tip : Literal["land", "chamfer", "rounding", "semi_topping"] | LandTip | ChamferTip | RoundingTip | SemiToppingTip | Mapping[str, Any], optional
        Corners of this gear's tips, when they are not the common ones.
    material : Material | Mapping[str, Any], optional
        Material of this gear, when it is not the common one.

    >>> shifted = GearSpecification(teeth=24, face_width=20e-3, bore_radius=18e-3, profile_shift=0.2, tip=RoundingTip(radius=0.3e-3))
    >>> Pair(module=3e-3, pinion=shifted, gear=shifted).pinion.profile_shift
    0.2
    """

    def __init__(
        self,
        *,
        teeth: int,
        face_width: Quantity,
        bore_radius: Quantity,
        profile_shift: float | None = None,
        tooth_thickness: Literal["allowance", "span", "over_balls"] | AllowanceToothThickness | SpanToothThickness | OverBallsToothThickness | Mapping[str, Any] | None = None,
        tip_radius: Quantity | None = None,
        tip_shortening: float | None = None,
        from_centre_distance: Literal["profile_shift", "tip_shortening", "both"] | None = None,
        measured_with: MeasuredWith | Mapping[str, Any] | None = None,
        rack: Rack | Mapping[str, Any] | None = None,
        pinion_cutter: PinionCutter | Mapping[str, Any] | None = None,
        root: Literal["trochoid", "arc", "tangent_arc", "optimised_arc"] | TrochoidRoot | ArcRoot | TangentArcRoot | OptimisedArcRoot | Mapping[str, Any] | None = None,
        tip: Literal["land", "chamfer", "rounding", "semi_topping"] | LandTip | ChamferTip | RoundingTip | SemiToppingTip | Mapping[str, Any] | None = None,
        material: Material | Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(
            teeth=teeth,
            face_width=face_width,
            bore_radius=bore_radius,
            profile_shift=profile_shift,
            tooth_thickness=tooth_thickness,
            tip_radius=tip_radius,
            tip_shortening=tip_shortening,
            from_centre_distance=from_centre_distance,
            measured_with=measured_with,
            rack=rack,
            pinion_cutter=pinion_cutter,
            root=root,
            tip=tip,
            material=material,
        )


class CentreDistanceAllowance(Declared):
    """What the centre distance may be off by: the limits of the backlash say what comes of it.

    Parameters
    ----------
    upper : number [m]
        Upper allowance A_ae. -0.1 to 0.1 m.
    lower : number [m]
        Lower allowance A_ai. -0.1 to 0.1 m.
    """

    def __init__(
        self,
        *,
        upper: Quantity,
        lower: Quantity,
    ) -> None:
        super().__init__(
            upper=upper,
            lower=lower,
        )


class Pair(_gearstudy.Pair):
    """Two involute spur gears on their centre distance, or one alone.

    Parameters
    ----------
    module : number [m]
        Module m. 1e-05 to 1 m.
    pressure_angle : number [rad], optional
        Pressure angle α of the basic rack. 0.08 to 0.785398 rad. Without it: 20 deg.
    rack : Rack | Mapping[str, Any], optional
        Basic rack that cuts both gears, in modules (ISO 53). Without it: the usual one.
    material : Material | Mapping[str, Any], optional
        Material of both gears. Without it: the usual one.
    pinion : GearSpecification | Mapping[str, Any]
        The gear the torque is given on.
    gear : GearSpecification | Mapping[str, Any]
        The mating gear.
    centre_distance : number [m], optional
        Centre distance a_w; the one without backlash of nominal profile shifts when it is not given. 1e-06 to 1000
        m.
    interference : Literal["usable", "refuse"], optional
        What becomes of a pair where a tip would touch below the mate's root form circle. Without it: usable.
    centre_distance_allowance : CentreDistanceAllowance | Mapping[str, Any], optional
        What the centre distance may be off by: the limits of the backlash say what comes of it.

    >>> gear = GearSpecification(teeth=24, face_width=20e-3, bore_radius="18 mm")
    >>> f"{Pair(module=3e-3, pinion=gear, gear=gear).centre_distance:.6f}"
    '0.072000'
    """

    def __new__(
        cls,
        *,
        module: Quantity,
        pinion: GearSpecification | Mapping[str, Any],
        gear: GearSpecification | Mapping[str, Any],
        pressure_angle: Quantity | None = None,
        rack: Rack | Mapping[str, Any] | None = None,
        material: Material | Mapping[str, Any] | None = None,
        centre_distance: Quantity | None = None,
        interference: Literal["usable", "refuse"] | None = None,
        centre_distance_allowance: CentreDistanceAllowance | Mapping[str, Any] | None = None,
    ) -> Pair:
        words: dict[str, Any] = dict(
            module=module,
            pressure_angle=pressure_angle,
            rack=rack,
            material=material,
            pinion=pinion,
            gear=gear,
            centre_distance=centre_distance,
            interference=interference,
            centre_distance_allowance=centre_distance_allowance,
        )
        words = {name: value for name, value in words.items() if value is not None}
        return super().__new__(cls, **words)


class Energy(Declared):
    """Cantilever of varying section (bending, shear, compression) on an elastic gear body.

    Parameters
    ----------
    shear_factor : number, optional
        How much more a section shears than under a uniform shear stress. 1 to 2. Without it: 1.2.
    body : Literal["sainsot", "ring"], optional
        What the gear body under the tooth is taken from. Without it: sainsot.
    arm : Literal["root_circle", "clamped_end"], optional
        Where the formula's arm of the load on the gear body is counted from. Without it: root_circle.
    harmonics : int, optional
        Harmonics of the elastic ring, times the half root angle; where an accuracy is wanted, as many as it takes.
        10 to 2000. Without it: 100.

    >>> Energy().name
    'energy'
    """

    name = "energy"

    def __init__(
        self,
        *,
        shear_factor: float | None = None,
        body: Literal["sainsot", "ring"] | None = None,
        arm: Literal["root_circle", "clamped_end"] | None = None,
        harmonics: int | None = None,
    ) -> None:
        super().__init__(
            shear_factor=shear_factor,
            body=body,
            arm=arm,
            harmonics=harmonics,
        )


class WeberBanaschek(Declared):
    """Cantilever of varying section in plane strain, clamped in a half plane, on a ring that winds up.

    >>> WeberBanaschek().name
    'weber_banaschek'
    """

    name = "weber_banaschek"



class Iso6336(Declared):
    """ISO 6336-1: a parabola over the path of contact with c′ as its top and c_γα as the mean of the mesh.

    Parameters
    ----------
    correction_factor : number, optional
        C_M: measured over theoretical stiffness. 0.1 to 2. Without it: 0.8.
    blank_factor : number, optional
        C_R: gear blank factor, 1 for solid discs, less for rims on webs. 0.1 to 2. Without it: 1.0.

    >>> Iso6336().name
    'iso6336'
    """

    name = "iso6336"

    def __init__(
        self,
        *,
        correction_factor: float | None = None,
        blank_factor: float | None = None,
    ) -> None:
        super().__init__(
            correction_factor=correction_factor,
            blank_factor=blank_factor,
        )


class FiniteElement(Declared):
    """Plane finite elements of the whole gear: teeth and body as one.

    Parameters
    ----------
    plane : Literal["strain", "stress"], optional
        The plane state of the gear. Without it: strain.
    elements_across : int, optional
        Elements across a tooth, an even number; all other sizes follow from it; where an accuracy is wanted, from
        how many on. 6 to 64. Without it: 16.

    >>> FiniteElement().name
    'finite_element'
    """

    name = "finite_element"

    def __init__(
        self,
        *,
        plane: Literal["strain", "stress"] | None = None,
        elements_across: int | None = None,
    ) -> None:
        super().__init__(
            plane=plane,
            elements_across=elements_across,
        )


class Stiffness(_gearstudy.Stiffness):
    """How a pair deflects, and how accurately that is to be known.

    Parameters
    ----------
    method : Literal["energy", "weber_banaschek", "iso6336", "finite_element"] | Energy | WeberBanaschek | Iso6336 | FiniteElement | Mapping[str, Any], optional
        How the compliance of a tooth is found. Without it: energy.
    root : Literal["trochoid", "circular_fillet", "base_circle"], optional
        The shape of the tooth below its involute. Without it: trochoid.
    contact : Literal["linear", "load_dependent", "resolved"], optional
        How the flanks flatten against each other: with finite elements `resolved` unless said otherwise, with
        other methods `linear`.
    coupling : Literal["none", "body"], optional
        Whether loaded neighbours deflect each other through the gear bodies. Without it: body.
    torque : number [N m], optional
        Torque on the pinion for the mesh stiffness, which all but the linear contact depend on. 1e-12 to 1e+09 N
        m.
    accuracy : number, optional
        Wanted accuracy of the compliances, relative to a tooth's own; the method takes the cheapest settings that
        meet it. 1e-12 to 0.1.

    >>> Stiffness(pair, method="energy", contact="load_dependent").contact
    'load_dependent'
    >>> Stiffness(pair, method=FiniteElement(elements_across=6), contact="resolved").error_estimate < 0.01
    True
    """

    def __new__(
        cls,
        pair: Pair,
        *,
        method: Literal["energy", "weber_banaschek", "iso6336", "finite_element"] | Energy | WeberBanaschek | Iso6336 | FiniteElement | Mapping[str, Any] | None = None,
        root: Literal["trochoid", "circular_fillet", "base_circle"] | None = None,
        contact: Literal["linear", "load_dependent", "resolved"] | None = None,
        coupling: Literal["none", "body"] | None = None,
        torque: Quantity | None = None,
        accuracy: Quantity | None = None,
    ) -> Stiffness:
        words: dict[str, Any] = dict(
            method=method,
            root=root,
            contact=contact,
            coupling=coupling,
            torque=torque,
            accuracy=accuracy,
        )
        words = {name: value for name, value in words.items() if value is not None}
        return super().__new__(cls, pair, **words)
