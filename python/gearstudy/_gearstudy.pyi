"""What is compiled. Lengths in metres, angles in radians, forces in newtons, pressures in pascals."""

from pathlib import Path
from typing import Any, Callable, Iterator, Literal, Sequence

import numpy
import numpy.typing
from typing_extensions import Self

from gearstudy.declared import Floats, Modification, Quantity, Search

__version__: str

Array = numpy.typing.NDArray[numpy.float64]
DesignLike = Design | Modification | Sequence[Modification] | None

class GearFacts:
    """What was stated of a gear, and what follows from it; :class:`Pair` has one for each of its gears.

    >>> pair.pinion.base_radius < pair.pinion.reference_radius < pair.pinion.tip_radius
    True
    """

    @property
    def teeth(self) -> int:
        """z: number of teeth."""
    @property
    def face_width(self) -> float:
        """b: face width [m]."""
    @property
    def bore_radius(self) -> float:
        """Radius of the bore [m]."""
    @property
    def profile_shift(self) -> float:
        """x: profile shift coefficient."""
    @property
    def reference_radius(self) -> float:
        """r: reference radius [m]."""
    @property
    def base_radius(self) -> float:
        """r_b: base radius [m]."""
    @property
    def tip_radius(self) -> float:
        """r_a: tip radius [m]."""
    @property
    def root_radius(self) -> float:
        """r_f: root radius [m]."""
    @property
    def form_radius(self) -> float:
        """r_Ff: root form radius, where the involute begins [m]."""
    @property
    def tip_thickness(self) -> float:
        """s_a: tooth thickness at the tip, along its circle [m]."""
    @property
    def undercut(self) -> bool:
        """Whether the tool removes a part of the involute at the root."""

class Pair:
    """Two spur gears on their centre distance; what it is made of, :class:`gearstudy.Pair` says.

    >>> pair.contact_ratio > 1
    True
    """

    def __new__(cls, **fields: Any) -> Self: ...
    @property
    def centre_distance(self) -> float:
        """a_w: centre distance [m]."""
    @property
    def working_pressure_angle(self) -> float:
        """α_w: working pressure angle [rad]."""
    @property
    def base_pitch(self) -> float:
        """p_b: base pitch, the length of a mesh cycle on the line of action [m]."""
    @property
    def contact_ratio(self) -> float:
        """ε_α: transverse contact ratio."""
    @property
    def tangent_length(self) -> float:
        """T1T2: length of the line of action between the base circles [m]."""
    @property
    def start_of_contact(self) -> float:
        """T1A: where contact begins, from the base circle of the pinion along the line of action [m]."""
    @property
    def end_of_contact(self) -> float:
        """T1E: where contact ends, from the base circle of the pinion along the line of action [m]."""
    @property
    def pinion(self) -> GearFacts:
        """What follows for the pinion."""
    @property
    def gear(self) -> GearFacts:
        """What follows for the gear."""

class Stiffness:
    """The compliances of a pair's teeth; what they are made of, :class:`gearstudy.Stiffness` says.

    >>> 0 <= stiffness.error_estimate < 1
    True
    """

    def __new__(cls, pair: Pair, **fields: Any) -> Self: ...
    @property
    def pair(self) -> Pair:
        """The pair that it is of."""
    @property
    def contact(self) -> str:
        """The contact law: linear, load_dependent or resolved."""
    @property
    def error_estimate(self) -> float:
        """How far a tooth's own compliance may be off, relatively."""
    @property
    def warnings(self) -> list[str]:
        """A sentence for each formula that is used outside its range."""
    def mesh(self, torque: Quantity | None = None, *, positions: int | None = None) -> tuple[Array, Array, float]:
        """The mesh stiffness of unmodified teeth over one cycle.

        Parameters
        ----------
        torque : number [N m], optional
            On the pinion; without it the one that was stated, or else 1 N m. It matters where the contact law depends on load.
        positions : int, optional
            Of the cycle, evenly spread. 8 to 100,000; 64 without it.

        Returns
        -------
        positions [m] and stiffness [N/m], both of shape (points,), and the mean stiffness [N/m].

        >>> position, stiff, mean = stiffness.mesh(150.0)
        >>> position.shape == stiff.shape
        True
        >>> bool(stiff.min() < mean < stiff.max())
        True
        """

class Design:
    """Modifications on the gears of a pair, checked once for many calls.

    Parameters
    ----------
    pair : Pair
        What they are for.
    modifications : modification, or sequence of modifications
        Single values only.

    Raises
    ------
    InvalidInput
        What does not fit the pair.

    >>> design = Design(pair, TipRelief(gear="both", amount=14e-6, fraction=0.8))
    >>> bool(peak_to_peak(stiffness, 150.0, design) == peak_to_peak(stiffness, 150.0, relief))
    True
    """

    def __new__(cls, pair: Pair, modifications: Modification | Sequence[Modification]) -> Self: ...
    @property
    def resolved(self) -> list[tuple[str, str, str, float]]:
        """Gear, family, name and value in SI of everything that was stated, and of what follows from it."""

class TransmissionError:
    """A curve over one mesh cycle, and what it comes to; :func:`transmission_error` makes it.

    Numbers of the whole cycle are there unless the call said ``summary=False``; asking for one then raises InvalidInput.
    Arrays of a curve have shape (points,), in the order of positions. There are as many points as :func:`len` says: those that
    were asked for and, on either side of each place where contact begins or ends, two more, and with a summary the extrema. An array is made when it is asked
    for.

    >>> curve = transmission_error(stiffness, 150.0, relief)
    >>> curve.transmission_error.shape == curve.cycle_position.shape == (len(curve),)
    True
    >>> ptp = curve.transmission_error.max() - curve.transmission_error.min()
    >>> bool(abs(curve.peak_to_peak / ptp - 1) < 0.01)
    True
    """

    def __len__(self) -> int: ...
    @property
    def cycle_position(self) -> Array:
        """Position in the mesh cycle along the line of action [m], from 0, shape (points,)."""
    @property
    def path_position(self) -> Array:
        """Contact of the leading pair along the line of action, from the point T1 where it touches the base circle of the pinion [m],
        shape (points,).
        """
    @property
    def roll_angle(self) -> Array:
        """Roll angle of the pinion at the contact of the leading pair [rad], shape (points,)."""
    @property
    def transmission_error(self) -> Array:
        """TE under load along the line of action [m], positive where the gear lags, shape (points,)."""
    @property
    def unloaded_transmission_error(self) -> Array:
        """TE without load along the line of action [m]: what the modifications alone make, shape (points,)."""
    @property
    def secant_stiffness(self) -> Array:
        """Normal force over the approach of the gears [N/m], shape (points,)."""
    @property
    def tangent_stiffness(self) -> Array:
        """Change of the normal force with the approach of the gears [N/m], shape (points,)."""
    @property
    def pairs(self) -> numpy.typing.NDArray[numpy.int64]:
        """How many pairs of teeth carry load, shape (points,), integers."""
    @property
    def loads(self) -> Array:
        """Normal force of each pair of teeth in contact [N], shape (points, pairs), 0 where one carries none."""
    @property
    def pressure(self) -> Array | None:
        """Largest Hertzian pressure of any contact [Pa], shape (points,); None unless the call said ``pressure=True``."""
    @property
    def peak_to_peak(self) -> float:
        """Largest less least transmission error of the cycle [m], found between points too."""
    @property
    def mean(self) -> float:
        """Mean of the transmission error over the cycle [m]."""
    @property
    def variance(self) -> float:
        """Mean square deviation of the transmission error from its mean over the cycle [m^2]."""
    @property
    def harmonics(self) -> Array:
        """Amplitudes of the mesh harmonics of the transmission error [m], the first first, shape (harmonics,)."""
    @property
    def unloaded_peak_to_peak(self) -> float:
        """Largest less least transmission error without load [m]."""
    @property
    def loaded_contact_ratio(self) -> float:
        """Share of the cycle, summed over the pairs, in which a pair carries load; the contact ratio under load."""
    @property
    def largest_load_share(self) -> float:
        """Largest share of the normal force on one pair, up to 1."""
    @property
    def largest_pressure(self) -> float | None:
        """Largest Hertzian pressure of the cycle [Pa]; None unless the call said ``pressure=True``."""

def transmission_error(
    stiffness: Stiffness,
    torque: Quantity,
    design: DesignLike = None,
    *,
    positions: int = 64,
    harmonics: int = 8,
    pressure: bool = False,
    summary: bool = True,
    slices: int = 17,
    corner_contact: Literal["none", "exact"] = "none",
    slice_coupling: Literal["none", "plate"] = "none",
) -> TransmissionError:
    """The transmission error of one design under one torque over a mesh cycle.

    Parameters
    ----------
    stiffness : Stiffness
        Of the pair.
    torque : number [N m]
        On the pinion. 0 to 1e9 N m.
    design : Design, modification, sequence of modifications, optional
        Unmodified teeth without it.
    positions : int
        Of the cycle, evenly spread. 8 to 100,000.
    harmonics : int
        How many mesh harmonics. 0 to 200.
    pressure : bool
        Whether Hertzian pressures are found.
    summary : bool
        Whether extrema between positions, means and harmonics are found; they take about half of the time.
    slices : int
        Across the face, where modifications vary along it and nothing is known in closed form; 17 without it.
    corner_contact : "none" or "exact"
        Whether teeth touch before and beyond the path of contact too, with the corners of their tips; "none" without it. Where
        that changes the peak-to-peak by more than 2 %, a UserWarning says by how much, but with ``summary=False``.
    slice_coupling : "none" or "plate"
        Whether slices support one another, as the tooth of a plate does; "none" without it. These three are fields of a study's
        ``ste`` too.

    Raises
    ------
    InvalidInput
        What makes no sense or does not fit the pair; arrays, which :func:`peak_to_peak` and :func:`summaries` take.
    RunFailed
        Where the gears approach farther than corner contact is modelled for.

    >>> curve = transmission_error(stiffness, 150.0, relief, harmonics=3)
    >>> curve.harmonics.shape
    (3,)
    >>> bool(1e-6 < curve.mean < 100e-6)
    True
    """
def peak_to_peak(
    stiffness: Stiffness,
    torque: Floats,
    design: DesignLike = None,
    *,
    positions: int = 64,
    threads: int = 1,
    invalid: Literal["raise", "nan"] = "raise",
    slices: int = 17,
    corner_contact: Literal["none", "exact"] = "none",
    slice_coupling: Literal["none", "plate"] = "none",
) -> Any:
    """The peak-to-peak transmission error [m] of one design under one torque, or of each of many.

    Parameters
    ----------
    stiffness : Stiffness
        Of the pair.
    torque : number [N m], or an array of shape (designs,)
        On the pinion. 0 to 1e9 N m.
    design : Design, modification, sequence of modifications, optional
        With arrays of shape (designs,) in any of its numbers; unmodified teeth without it.
    positions : int
        Of the cycle, evenly spread. 8 to 100,000.
    threads : int
        On which designs are spread; 0 for as many as the machine has. They change no bit of any number.
    invalid : "raise" or "nan"
        What becomes of a design that does not fit the pair, or is loaded beyond the model.
    slices, corner_contact, slice_coupling
        As :func:`transmission_error` has them, but no warning reports what ``corner_contact="none"`` changes.

    Returns
    -------
    float, or an array of shape (designs,) where anything was given as an array.

    Raises
    ------
    InvalidInput
        What makes no sense, and which element of an array it is; arrays of different lengths.
    RunFailed
        Where the gears approach farther than corner contact is modelled for.
    KeyboardInterrupt
        Ctrl-C.

    >>> import numpy as np
    >>> amounts = np.array([0.0, 7e-6, 14e-6])
    >>> found = peak_to_peak(stiffness, 150.0, TipRelief(gear="both", amount=amounts, fraction=0.8))
    >>> found.shape
    (3,)
    >>> bool(found[0] == peak_to_peak(stiffness, 150.0))
    True
    """
def summaries(
    stiffness: Stiffness,
    torque: Floats,
    design: DesignLike = None,
    *,
    positions: int = 64,
    harmonics: int = 8,
    pressure: bool = False,
    threads: int = 1,
    invalid: Literal["raise", "nan"] = "raise",
    slices: int = 17,
    corner_contact: Literal["none", "exact"] = "none",
    slice_coupling: Literal["none", "plate"] = "none",
) -> dict[str, Array]:
    """What the transmission errors of many designs come to.

    Parameters are those of :func:`peak_to_peak`, with ``harmonics`` and ``pressure`` of :func:`transmission_error`.

    Returns
    -------
    dict from name to an array of shape (designs,), in SI units: the numbers of a curve that the table ``summary`` of the stage ``ste``
    has, by its names, those of pressure with ``pressure`` only; and ``harmonic_1`` on in metres. With ``invalid="nan"`` a design that
    does not fit, or approaches farther than corner contact is modelled for, has NaN throughout.

    >>> found = summaries(stiffness, [100.0, 150.0], relief, harmonics=1)
    >>> sorted(found)[:3]
    ['harmonic_1', 'largest_load_share', 'loaded_contact_ratio']
    >>> bool(found["mean"][0] < found["mean"][1])
    True
    """

class Candidate:
    """The best point of a search; :attr:`Optimizer.best` has it.

    >>> search = Optimizer("sobol", [(0, 1)])
    >>> search.tell(search.ask()[:, 0])
    >>> search.best.point.shape
    (1,)
    """

    @property
    def point(self) -> Array:
        """One value for each variable, shape (variables,)."""
    @property
    def value(self) -> float:
        """The objective there; the first of several."""
    @property
    def violation(self) -> float:
        """The sum of what constraints are below 0; 0 where all are kept."""

class Optimizer:
    """A search of a box by one of the methods, with one objective or several: asked for points, told what they are worth.

    Parameters
    ----------
    method : str or Search
        A name of a method, or one with settings such as ``DifferentialEvolution(population=40)``.
    bounds : sequence of (least, most)
        One pair for each variable.
    seed : int
        Where random numbers start; the same seed asks for the same points.

    Raises
    ------
    InvalidInput
        Bounds or settings that make no sense.

    >>> search = Optimizer("differential_evolution", [(-5, 5), (-5, 5)], seed=1)
    >>> while not search.finished:
    ...     points = search.ask()
    ...     search.tell((points**2).sum(axis=1))
    >>> search.best.value < 1e-3
    True
    """

    def __new__(cls, method: str | Search, bounds: Sequence[tuple[float, float]] | Array, *, seed: int = 0) -> Self: ...
    def ask(self) -> Array:
        """The points to evaluate next, shape (points, variables); no points when the search has ended. Asked again before they
        were told of, it gives the same.
        """
    def tell(self, values: Any, constraints: Any = None) -> None:
        """Tells what the points that were asked for are worth.

        Parameters
        ----------
        values : array of shape (points,), or (points, objectives)
            The less the better; NaN or infinity where there is no value.
        constraints : array of shape (points,), or (points, constraints), optional
            Kept where they are not negative.

        Raises
        ------
        InvalidInput
            Another shape.
        RunFailed
            Another number of points than was asked for.
        """
    @property
    def finished(self) -> bool:
        """Whether it has ended."""
    @property
    def reason(self) -> str | None:
        """Why it has ended; None before."""
    @property
    def evaluations(self) -> int:
        """How many points it was told of."""
    @property
    def best(self) -> Candidate | None:
        """The best point so far; None where none has a value."""
    @property
    def front(self) -> list[Array]:
        """Of several objectives: the points that no other one dominates, shape (points, variables), and their values, shape (points,
        objectives).
        """

class Table:
    """A table of a stage; :attr:`gearstudy.Study.tables` has them by name.

    pandas, polars, pyarrow and DuckDB read it by the Arrow PyCapsule interface (``polars.DataFrame(table)``,
    ``pyarrow.table(table)``, ``pandas.DataFrame.from_arrow(table)``), with units in the metadata of its fields; pandas by itself
    knows no metadata of fields, which :meth:`to_pandas` gives it.

    >>> table = study.tables["ste.summary"]
    >>> table["peak_to_peak"].shape == (len(table),)
    True
    >>> table.units["peak_to_peak"]
    'um'
    """

    @property
    def name(self) -> str:
        """The names of its stage and its own, ``stage.table``."""
    @property
    def description(self) -> str:
        """What it has, in a sentence."""
    @property
    def columns(self) -> list[str]:
        """The names of its columns, in order."""
    @property
    def key_columns(self) -> list[str]:
        """The columns that tell its rows apart."""
    @property
    def units(self) -> dict[str, str]:
        """Unit by column, of those that have one: that in which its values are."""
    @property
    def descriptions(self) -> dict[str, str]:
        """Description by column."""
    def __len__(self) -> int: ...
    def __getitem__(self, column: str) -> Any: ...
    def __contains__(self, column: object) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...
    def keys(self) -> list[str]:
        """The names of its columns; with them ``dict(table)`` has all of it."""
    def to_pandas(self) -> Any:
        """A DataFrame of pandas, whose ``attrs`` have the table's ``name`` and ``description``, and ``units`` and ``descriptions`` by column.

        >>> frame = study.tables["ste.summary"].to_pandas()
        >>> frame.attrs["units"]["torque"]
        'N m'
        """
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

class Study:
    """A study, read and checked, and where its results lie; :class:`gearstudy.Study` has the rest.

    >>> study.stages["ste"]
    'ste'
    """

    def __new__(
        cls,
        text: str | None,
        path: Path,
        *,
        set: list[str] = ...,
        name: str | None = None,
        results: Path = ...,
        cache: Path | None = None,
    ) -> Self: ...
    @property
    def name(self) -> str:
        """Its name, that of its folder in the results."""
    @property
    def title(self) -> str:
        """Its title; empty where it has none."""
    @property
    def stages(self) -> dict[str, str]:
        """The names of its stages and the kind of each, in the order of the file."""
    @property
    def folder(self) -> Path:
        """The folder of its results."""
    @property
    def report(self) -> Path | None:
        """The page that shows its results; None before it was run."""
    def _run(
        self,
        *,
        only: list[str],
        want: list[str],
        force: bool | list[str],
        jobs: int,
        keep_going: bool,
        limit_memory: int | None,
        limit_rows: int | None,
        progress: Callable[[dict[str, Any]], None] | None,
    ) -> list[str]: ...
    def _plan(self, *, only: list[str], want: list[str], force: bool | list[str]) -> dict[str, Any]:
        """What a run would do, as `gearstudy plan --format json` has it."""
    def _diff(self, before: Study) -> dict[str, Any]:
        """What differs between the results of this study and those of another one, as `gearstudy diff --format json` has it."""
    def _tables(self) -> list[str]:
        """The names of the tables that the last run published."""
    def _table(self, name: str) -> Table: ...

def command_line(words: list[str]) -> int:
    """Runs the program with these words, the first being its own name, and gives its exit code.

    >>> command_line(["gearstudy", "--version"])  # doctest: +SKIP
    0
    """
def declarations() -> str:
    """All of them, as JSON: what a pair, a stiffness and a mesh cycle are made of, and the members of each family."""
