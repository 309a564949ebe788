"""Kernels against closed forms, against each other, and against what a study computes by another way."""

import math
import warnings

import numpy as np
import pytest

import gearstudy as gs
from conftest import ROOT, spur_pair


def test_a_pair_has_the_contact_ratio_of_its_circles(pair):
    module, alpha, teeth = 3e-3, math.radians(20), (19, 48)
    tips = [module * (z / 2 + 1) for z in teeth]
    bases = [module * z / 2 * math.cos(alpha) for z in teeth]
    line = sum(math.sqrt(tip**2 - base**2) for tip, base in zip(tips, bases))
    distance = module * sum(teeth) / 2
    path = line - distance * math.sin(alpha)
    assert pair.contact_ratio == pytest.approx(path / (math.pi * module * math.cos(alpha)), rel=1e-12)
    assert pair.centre_distance == pytest.approx(distance, rel=1e-12)
    assert pair.pinion.base_radius == pytest.approx(bases[0], rel=1e-14)
    assert pair.gear.teeth == 48 and not pair.gear.undercut


def test_loads_balance_the_torque_everywhere(pair, stiffness, relief):
    torque = 80.0
    curve = gs.transmission_error(stiffness, torque, relief)
    force = torque / pair.pinion.base_radius
    assert curve.loads.sum(axis=1) == pytest.approx(np.full(len(curve), force), rel=1e-12)
    assert (curve.loads >= 0).all()
    assert curve.transmission_error.max() - curve.transmission_error.min() == pytest.approx(curve.peak_to_peak, rel=1e-12)


def test_harmonics_are_those_of_the_curve(stiffness, relief):
    """Numpy's transform of equidistant values of the sampled curve."""
    curve = gs.transmission_error(stiffness, 80.0, relief, positions=2000, harmonics=4)
    position, error = curve.cycle_position, curve.transmission_error
    count = 4096
    period = position[-1] - position[0]
    even = np.interp(position[0] + period * np.arange(count) / count, position, error)
    amplitudes = 2 * np.abs(np.fft.rfft(even)[1:5]) / count
    assert curve.harmonics == pytest.approx(amplitudes, rel=2e-4)
    assert curve.mean == pytest.approx(even.mean(), rel=1e-6)


def test_a_curve_alone_is_the_same_curve(stiffness):
    relief = gs.TipRelief(gear="both", amount=20e-6, fraction=0.7)
    whole, alone = (gs.transmission_error(stiffness, 80.0, relief, summary=summary) for summary in (True, False))
    both, of_whole, of_alone = np.intersect1d(whole.cycle_position, alone.cycle_position, return_indices=True)
    assert 64 <= len(both) < len(alone) < len(whole), "integrals need more points than values do"
    assert (whole.transmission_error[of_whole] == alone.transmission_error[of_alone]).all()
    between = np.interp(alone.cycle_position, whole.cycle_position, whole.transmission_error)
    assert alone.transmission_error == pytest.approx(between, rel=1e-3)
    assert "peak_to_peak" in repr(whole) and "peak_to_peak" not in repr(alone)
    for name in ("peak_to_peak", "mean", "variance", "harmonics", "largest_pressure", "largest_load_share"):
        with pytest.raises(gs.InvalidInput, match="no summary.*summary=False"):
            getattr(alone, name)


def test_a_trace_is_points_of_arrays_or_texts(pair, stiffness):
    """A parabola over the roll length as arrays and as texts with units; what was measured of another gear is refused."""
    flank = np.linspace(2e-3, 16.5e-3, 200)
    middle = 9e-3
    trace = gs.MeasuredRelief(gear="pinion", roll_lengths=flank, deviations=-0.1 * (flank - middle) ** 2, teeth=19, module=3e-3)
    texts = gs.MeasuredRelief(
        gear="pinion",
        roll_lengths=[f"{1e3 * length:.15g} mm" for length in flank],
        deviations=[f"{-1e5 * (length - middle) ** 2:.15g} um" for length in flank],
    )
    one, other = (gs.transmission_error(stiffness, 80.0, design).peak_to_peak for design in (trace, texts))
    assert one == pytest.approx(other, rel=1e-9) and one > 0
    with pytest.raises(gs.InvalidInput, match="a gear of 19 teeth was measured, and this one has 48"):
        gs.Design(pair, gs.MeasuredRelief(gear="gear", roll_lengths=flank, deviations=0 * flank, teeth=19))


def test_gears_as_made():
    """x_E = x + A_s/(2 m tan alpha) moves the root and leaves the tip; an undercut pair runs on what is left of the path."""
    sized = {"face_width": 20e-3, "bore_radius": 8e-3}
    thin = gs.AllowanceToothThickness(upper=-60e-6, lower=-90e-6)
    pinion, gear = (gs.GearSpecification(teeth=teeth, tooth_thickness=thickness, **sized) for teeth, thickness in ((19, thin), (48, None)))
    nominal, made = (gs.Pair(module=3e-3, pinion=one, gear=gear) for one in (gs.GearSpecification(teeth=19, **sized), pinion))
    deeper = 75e-6 / (2 * math.tan(math.radians(20)))
    assert nominal.pinion.root_radius - made.pinion.root_radius == pytest.approx(deeper, rel=1e-9)
    assert (made.pinion.tip_radius, made.centre_distance) == (nominal.pinion.tip_radius, nominal.centre_distance)
    undercut = {"module": 3e-3, "pinion": gs.GearSpecification(teeth=12, **sized), "gear": gear}
    pair = gs.Pair(**undercut)
    base, form = pair.pinion.base_radius, pair.pinion.form_radius
    assert pair.start_of_contact == pytest.approx(math.sqrt(form**2 - base**2), rel=1e-9)
    with pytest.raises(gs.InvalidInput, match="interference.*below the form radius"):
        gs.Pair(**undercut, interference="refuse")


def test_mesh_stiffness_is_force_over_approach_of_unmodified_gears(pair, stiffness):
    _, stiff, mean = stiffness.mesh()
    curve = gs.transmission_error(stiffness, 50.0)
    assert curve.secant_stiffness.min() == pytest.approx(min(stiff), rel=1e-9)
    assert min(stiff) < mean < max(stiff)


def test_many_designs_are_each_by_itself(stiffness):
    amounts = np.linspace(1e-6, 25e-6, 150)
    torques = np.linspace(20.0, 200.0, 150)
    relief = gs.TipRelief(gear="both", amount=amounts, fraction=0.7)
    crown = gs.LeadCrowning(gear="pinion", amount=4e-6)
    together = gs.peak_to_peak(stiffness, torques, [relief, crown])
    for index in (0, 77, 149):
        own = gs.TipRelief(gear="both", amount=amounts[index], fraction=0.7)
        curve = gs.transmission_error(stiffness, torques[index], [own, crown])
        assert together[index] == pytest.approx(curve.peak_to_peak, rel=1e-9)
    assert (together == gs.peak_to_peak(stiffness, torques, [relief, crown], threads=2)).all()
    found = gs.summaries(stiffness, torques, [relief, crown], harmonics=2)
    assert found["peak_to_peak"] == pytest.approx(together, rel=1e-9)
    assert set(found) >= {"mean", "harmonic_1", "harmonic_2"} and "harmonic_3" not in found


def test_a_design_is_what_its_modifications_are(pair, stiffness, relief):
    design = gs.Design(pair, [relief])
    assert gs.peak_to_peak(stiffness, 90.0, design) == gs.peak_to_peak(stiffness, 90.0, relief)
    resolved = {(gear, name): value for gear, _, name, value in design.resolved}
    assert resolved["pinion", "amount"] == 12e-6


def test_finite_elements_with_resolved_contact_are_near_the_energy_method(pair, stiffness):
    fine = gs.Stiffness(pair, method=gs.FiniteElement(elements_across=8), torque=50.0)
    assert fine.contact == "resolved" and fine.error_estimate < 5e-3
    one, other = (gs.transmission_error(each, 50.0, pressure=True) for each in (stiffness, fine))
    assert one.mean == pytest.approx(other.mean, rel=0.25)
    assert other.largest_pressure > 1e8 and (other.pressure > 0).all()


def test_a_study_says_the_same(quick):
    """The stage `ste` reads the pair and its compliances back from tables."""
    gears, summary = quick.tables["pair.gears"], quick.tables["ste.summary"]
    radii = dict(zip(gears["gear"], gears["bore_radius"]))
    widths = dict(zip(gears["gear"], gears["face_width"]))
    teeth = dict(zip(gears["gear"], gears["teeth"]))
    gear = {
        side: gs.GearSpecification(teeth=int(teeth[side]), face_width=f"{widths[side]} mm", bore_radius=f"{radii[side]} mm")
        for side in ("pinion", "gear")
    }
    pair = gs.Pair(module=f"{gears['module'][0]} mm", **gear)
    stiffness = gs.Stiffness(pair)
    unmodified = [row for row, design in enumerate(summary["design"]) if design == "unmodified"]
    assert unmodified
    for row in unmodified:
        curve = gs.transmission_error(stiffness, summary["torque"][row])
        assert curve.peak_to_peak * 1e6 == pytest.approx(summary["peak_to_peak"][row], rel=1e-9)
        assert curve.mean * 1e6 == pytest.approx(summary["mean"][row], rel=1e-9)


def test_units_of_pint_are_taken(stiffness):
    pint = pytest.importorskip("pint")
    units = pint.UnitRegistry()
    relief = gs.TipRelief(gear="both", amount=12 * units.micrometer, length=3 * units.millimeter)
    plain = gs.TipRelief(gear="both", amount="12 um", length=3e-3)
    torque = 80 * units.newton * units.meter
    assert gs.peak_to_peak(stiffness, torque, relief) == gs.peak_to_peak(stiffness, 80.0, plain)
    pair = spur_pair(pressure_angle=20 * units.degree, module=3 * units.millimeter)
    assert pair.contact_ratio == pytest.approx(spur_pair().contact_ratio, rel=1e-14)
    many = gs.TipRelief(gear="both", amount=np.array([5, 12]) * units.micrometer, fraction=0.5)
    assert gs.peak_to_peak(stiffness, 80.0, many).shape == (2,)
    for wrong in (3 * units.second, 3 * units.newton):
        with pytest.raises(gs.InvalidInput, match="length"):
            gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(gear="both", amount=wrong, fraction=0.5))


def test_searches_find_what_scipy_finds(stiffness):
    optimize = pytest.importorskip("scipy.optimize")

    def error(point):
        relief = gs.TipRelief(gear="both", amount=point[..., 0], fraction=point[..., 1])
        return gs.peak_to_peak(stiffness, 120.0, relief, positions=16)

    bounds = [(0.0, 30e-6), (0.3, 1.0)]
    ours = gs.minimize(error, bounds, method=gs.DifferentialEvolution(), seed=1, vectorized=True)
    theirs = optimize.differential_evolution(error, bounds, seed=1, popsize=10, maxiter=60, tol=1e-8)
    assert ours.value == pytest.approx(theirs.fun, rel=0.02)
    again = gs.minimize(error, bounds, method=gs.DifferentialEvolution(), seed=1, vectorized=True)
    assert (again.point == ours.point).all() and again.evaluations == ours.evaluations


def test_a_front_is_that_of_two_parabolas():
    """x² and (x − 2)²: the front is x from 0 to 2, √f₁ + √f₂ = 2."""
    search = gs.Optimizer(gs.Nsga2(population=40, generations=60), [(-5.0, 5.0)], seed=3)
    while not search.finished:
        points = search.ask()
        search.tell(np.column_stack([points[:, 0] ** 2, (points[:, 0] - 2) ** 2]))
    points, values = search.front
    assert len(points) >= 20 and points.min() > -0.05 and points.max() < 2.05
    assert np.sqrt(values).sum(axis=1) == pytest.approx(np.full(len(values), 2.0), abs=0.05)


def test_constraints_are_kept():
    """x + y least where x y ≥ 1, both positive: 1, 1."""
    search = gs.Optimizer("differential_evolution", [(0.1, 5.0), (0.1, 5.0)], seed=2)
    while not search.finished:
        points = search.ask()
        search.tell(points.sum(axis=1), (points[:, 0] * points[:, 1] - 1)[:, None])
    assert search.best.point == pytest.approx([1.0, 1.0], abs=2e-2)
    assert search.best.violation == 0 and search.reason


def test_the_generated_classes_are_those_of_the_program():
    import subprocess
    import sys

    from gearstudy import _gearstudy

    words = [sys.executable, str(ROOT / "python" / "generate"), "--check", _gearstudy.__file__]
    ended = subprocess.run(words, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr


def test_a_curve_warns_of_corners_that_it_leaves_out(stiffness):
    """The curve with corner contact is the second method."""
    wheel = gs.GearSpecification(teeth=30, face_width=15e-3, bore_radius=8e-3)
    soft = gs.Stiffness(spur_pair(module=2e-3, pinion=wheel, gear=wheel, material=gs.Material(youngs_modulus=3.2e9, poisson_ratio=0.35)))
    exact = gs.transmission_error(soft, 10.0, corner_contact="exact").peak_to_peak
    with pytest.warns(UserWarning, match="tip corners touch") as caught:
        without = gs.transmission_error(soft, 10.0).peak_to_peak
    assert len(caught) == 1 and caught[0].filename == __file__
    percent = 100 * (without / exact - 1)
    assert f"{percent:.0f} % too large" in str(caught[0].message) and percent > 50
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gs.transmission_error(soft, 10.0, corner_contact="exact")
        gs.transmission_error(stiffness, 1.0)
        gs.transmission_error(stiffness, 1e-310)
        gs.transmission_error(stiffness, 1.0, gs.TipRelief(gear="both", amount=60e-6, fraction=1.0))
        with pytest.raises(UserWarning, match="corner_contact"):
            gs.transmission_error(soft, 10.0)
