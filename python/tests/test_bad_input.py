"""Whatever Python gives: an exception that says what, or a right answer, never a crash."""

import math
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import gearstudy as gs
from conftest import spur_pair

TIP = {"gear": "both", "amount": 12e-6, "fraction": 0.9}


@pytest.mark.parametrize(
    "torque",
    ["80", "80 mm", "many", math.nan, math.inf, -1.0, 1e12, True, None, [], [[1.0, 2.0]], ["a"], 1j, object(), {"a": 1}, b"80"],
)
def test_torques(stiffness, torque):
    with pytest.raises((gs.InvalidInput, TypeError)) as raised:
        gs.peak_to_peak(stiffness, torque)
    assert "torque" in str(raised.value) or "argument" in str(raised.value)


@pytest.mark.parametrize("torque", [80, 80.0, "80 N m", "8e4 N mm", np.float64(80), np.float32(80), np.int64(80), Fraction(80), Decimal(80), np.array(80.0)])
def test_torques_that_are_one(stiffness, torque):
    assert gs.peak_to_peak(stiffness, torque) == gs.peak_to_peak(stiffness, 80.0)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"amount": -1e-6}, "may be 0 m to 0.005 m"),
        ({"amount": math.nan}, "amount"),
        ({"amount": "12"}, "a length in SI"),
        ({"amount": "12 N"}, "a length in SI"),
        ({"amount": True}, "amount"),
        ({"amount": np.array([])}, "empty array"),
        ({"amount": np.zeros((2, 2))}, "shape [2, 2]"),
        ({"amount": np.array(["a"])}, "type <U1"),
        ({"amount": np.array([1e-6, np.nan])}, "element 1"),
        ({"amount": [1e-6, 1.0]}, "element 1"),
        ({"gear": "pinon"}, "did you mean `pinion`"),
        ({"gear": 1}, "one of pinion, gear, both"),
        ({"curve": "linear", "exponent": 2.0}, "exponent"),
        ({"fraction": None}, "exactly one of"),
        ({"length": 1e-3}, "`length`"),
        ({"fraction": 9.0}, "active flank is"),
        ({"fraction": 11.0}, "may be 0 to 10"),
        ({"iso_amount": {"tangential_load": "1 kN"}}, "iso_amount"),
    ],
)
def test_reliefs(stiffness, changes, said):
    with pytest.raises(gs.InvalidInput) as raised:
        gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(**{**TIP, **changes}))
    assert said in str(raised.value)


def test_words_that_nobody_knows(stiffness):
    for wrong in (
        lambda: gs.TipRelief(amout=1e-6, **TIP),
        lambda: gs.Pair(modul=3e-3),
        lambda: gs.Stiffness(stiffness.pair, method="energie"),
        lambda: gs.Stiffness(stiffness.pair, method={"finite_element": {"elements": 8}}),
        lambda: gs.Stiffness(stiffness.pair, method=gs.FiniteElement(elements_across=7)),
        lambda: gs.Stiffness(stiffness.pair, method=gs.FiniteElement(), contact="hertz"),
        lambda: gs.Stiffness("pair"),
        lambda: gs.peak_to_peak(stiffness, 80.0, "tip_relief"),
        lambda: gs.peak_to_peak(stiffness, 80.0, gs.FiniteElement()),
        lambda: gs.peak_to_peak(stiffness, 80.0, [gs.TipRelief(**TIP), 3]),
        lambda: gs.peak_to_peak(stiffness, 80.0, slice_coupling="disc"),
        lambda: gs.peak_to_peak(stiffness, 80.0, slices=0),
        lambda: gs.peak_to_peak(stiffness, 80.0, slices=500, slice_coupling="plate"),
        lambda: gs.peak_to_peak(stiffness, 80.0, positions=7),
        lambda: gs.peak_to_peak(stiffness, 80.0, positions=-1),
        lambda: gs.peak_to_peak(stiffness, 80.0, invalid="skip"),
        lambda: gs.peak_to_peak(stiffness, 80.0, threads=-1),
        lambda: gs.transmission_error(stiffness, [1.0, 2.0]),
        lambda: gs.transmission_error(stiffness, 80.0, gs.LeadCrowning(gear="pinion", amount=[1e-6, 2e-6])),
        lambda: gs.transmission_error(stiffness, 80.0, harmonics=201),
        lambda: gs.summaries(stiffness, [1.0, 2.0], gs.LeadCrowning(gear="pinion", amount=[1e-6, 2e-6, 3e-6])),
        lambda: gs.Optimizer("annealing", [(0, 1)]),
        lambda: gs.Optimizer("genetic", [(1, 0)]),
        lambda: gs.Optimizer("genetic", []),
        lambda: gs.Optimizer("genetic", [(0, math.nan)]),
        lambda: gs.Optimizer(gs.Genetic(population=1), [(0, 1)]),
    ):
        with pytest.raises((gs.InvalidInput, TypeError)):
            wrong()
    for name in ("positions", "harmonics", "threads"):
        for value in (-1, 2**70, 1.5):
            with pytest.raises(TypeError, match=name):
                gs.summaries(stiffness, 80.0, **{name: value})


@pytest.mark.parametrize("teeth", [3, 4, 10_001, -19, 19.5, "19", True])
def test_gears_that_cannot_be(teeth):
    with pytest.raises(gs.InvalidInput):
        spur_pair(pinion=gs.GearSpecification(teeth=teeth, face_width=20e-3, bore_radius=14e-3))


def test_searches_that_are_told_wrong():
    search = gs.Optimizer("genetic", [(0.0, 1.0)])
    count = len(search.ask())
    for wrong in (np.zeros(count + 1), ["a"] * count, np.zeros((count, 0)), np.zeros((count, 1, 1)), np.full(count, -np.inf)):
        with pytest.raises((gs.GearstudyError, TypeError)):
            search.tell(wrong)
    with pytest.raises(gs.InvalidInput, match="constraints"):
        search.tell(np.zeros(count), np.zeros((count - 1, 1)))
    search.tell(np.full(count, np.nan))
    with pytest.raises(gs.RunFailed):
        gs.minimize(lambda point: math.nan, [(0.0, 1.0)], method=gs.Sobol(points=16))


def test_arrays_of_any_stride_and_type(stiffness):
    amounts = np.linspace(2e-6, 20e-6, 40)
    expected = gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(**{**TIP, "amount": amounts}))
    backwards = amounts[::-1]
    turned = gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(**{**TIP, "amount": backwards}))
    assert (turned[::-1] == expected).all()
    wide = np.zeros((40, 3))
    wide[:, 1] = amounts
    assert (gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(**{**TIP, "amount": wide[:, 1]})) == expected).all()
    swapped = amounts.astype(">f8")
    assert (gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(**{**TIP, "amount": swapped})) == expected).all()
    single = gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(**{**TIP, "amount": amounts.astype(np.float32)}))
    assert single == pytest.approx(expected, rel=1e-4)
    assert (gs.peak_to_peak(stiffness, np.arange(10, 20), None) > 0).all()
    amounts.setflags(write=False)
    assert (gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(**{**TIP, "amount": amounts})) == expected).all()


def test_designs_that_do_not_fit_are_told_or_left_out(stiffness):
    fractions = np.array([0.5, 5.0, 0.9])
    relief = gs.TipRelief(gear="both", amount=12e-6, fraction=fractions)
    with pytest.raises(gs.InvalidInput, match="element 1"):
        gs.peak_to_peak(stiffness, 80.0, relief)
    found = gs.peak_to_peak(stiffness, 80.0, relief, invalid="nan")
    assert np.isnan(found).tolist() == [False, True, False]
    assert np.isnan(gs.summaries(stiffness, 80.0, relief, invalid="nan")["mean"]).tolist() == [False, True, False]


def test_loads_beyond_the_model_are_told_or_left_out(stiffness):
    torques = np.array([80.0, 1e8])
    words = {"corner_contact": "exact"}
    with pytest.raises(gs.RunFailed, match="^element 1: the gears approach by [0-9.e+-]+ mm, but `corner_contact: exact` holds up to"):
        gs.peak_to_peak(stiffness, torques, **words)
    with pytest.raises(gs.RunFailed, match="^element 1: the gears approach by [0-9.e+-]+ mm, but `corner_contact: exact` holds up to"):
        gs.summaries(stiffness, torques, **words)
    with pytest.raises(gs.RunFailed, match="^the gears approach by [0-9.e+-]+ mm, but `corner_contact: exact` holds up to"):
        gs.peak_to_peak(stiffness, 1e8, **words)
    with pytest.raises(gs.RunFailed, match="^the gears approach by [0-9.e+-]+ mm, but `corner_contact: exact` holds up to"):
        gs.transmission_error(stiffness, 1e8, **words)
    assert np.isnan(gs.peak_to_peak(stiffness, torques, invalid="nan", **words)).tolist() == [False, True]
    assert np.isnan(gs.peak_to_peak(stiffness, 1e8, invalid="nan", **words))


def test_errors_say_where_and_what_to_do(tmp_path):
    file = tmp_path / "wrong.yaml"
    file.write_text("study: wrong\nstages:\n  pair:\n    kind: geometry\n    module: 3 mm\n    pinion: { teeth: 24 }\n")
    with pytest.raises(gs.InvalidStudy) as raised:
        gs.load(file)
    assert raised.value.file == str(file) and raised.value.line == 6 and raised.value.column
    assert len(raised.value.mistakes) >= 2 and raised.value.mistakes[0]["line"] == 6
    with pytest.raises(gs.InvalidInput) as beyond:
        spur_pair(module=3.0)
    assert beyond.value.help == "it may be 0.00001 m to 1 m" and str(beyond.value).startswith("`module` is 3 m")


def test_units_are_minded_in_arrays_and_whatever_base_they_have(stiffness):
    pint = pytest.importorskip("pint")
    expected = gs.peak_to_peak(stiffness, np.array([80.0, 100.0]))
    for system in ("mks", "cgs", "imperial", "US"):
        unit = pint.UnitRegistry(system=system)
        assert gs.peak_to_peak(stiffness, np.array([80e3, 100e3]) * unit.N * unit.mm) == pytest.approx(expected, rel=1e-12)
        assert gs.peak_to_peak(stiffness, 80 * unit.N * unit.m) == pytest.approx(expected[0], rel=1e-12)
        assert gs.peak_to_peak(stiffness, [80 * unit.N * unit.m, "100 N m"]) == pytest.approx(expected, rel=1e-12)
        assert spur_pair(module=3 * unit.mm).base_pitch == pytest.approx(stiffness.pair.base_pitch, rel=1e-12)
        assert spur_pair(pressure_angle=20 * unit.degree).base_pitch == pytest.approx(stiffness.pair.base_pitch, rel=1e-12)
        relief = gs.TipRelief(gear="both", amount=np.array([12.0]) * unit.um, fraction=0.9)
        assert gs.peak_to_peak(stiffness, 80.0, relief)[0] == pytest.approx(gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(**TIP)))
        for wrong in (np.array([80, 100]) * unit.N, np.array([80.0]) * unit.dimensionless, 80 * unit.s):
            with pytest.raises(gs.InvalidInput):
                gs.peak_to_peak(stiffness, wrong)


def test_what_only_looks_like_numbers(stiffness):
    masked = np.ma.array([80.0, 100.0], mask=[False, True])
    ragged = [[1.0], [1.0, 2.0]]
    for wrong in (masked, np.True_, ragged, np.array([1j]), np.array([True])):
        with pytest.raises(gs.InvalidInput):
            gs.peak_to_peak(stiffness, wrong)
    search = gs.Optimizer("sobol", np.array([[0.0, 1.0], [2.0, 3.0]]))
    count = len(search.ask())
    for wrong in ([1j] * count, ["1"] * count, [None] * count, [True] * count, np.ma.zeros(count)):
        with pytest.raises(gs.InvalidInput):
            search.tell(wrong)
    assert search.evaluations == 0
    for wrong in ([(0.0,)], [(0.0, 1.0, 2.0)], "ab", [0.0, 1.0], None):
        with pytest.raises(gs.InvalidInput):
            gs.Optimizer("sobol", wrong)


def test_objectives_stay_as_many_as_they_were():
    search = gs.Optimizer("nsga2", [(0, 1)] * 2)
    search.tell(np.random.rand(len(search.ask()), 2))
    for wrong in (1, 3):
        with pytest.raises(gs.RunFailed, match="objectives"):
            search.tell(np.random.rand(len(search.ask()), wrong))
    search.tell(np.random.rand(len(search.ask()), 2))
    assert search.front[1].shape[1] == 2
    with pytest.raises(gs.InvalidInput, match="minimises one"):
        single = gs.Optimizer("genetic", [(0, 1)])
        single.tell(np.random.rand(len(single.ask()), 2))


def test_signals_stay_what_they_are(stiffness):
    class Stopping:
        def __array__(self, *_, **__):
            raise KeyboardInterrupt

        def __float__(self):
            raise KeyboardInterrupt

        __index__ = __float__

    for call in (
        lambda: gs.Optimizer("sobol", [(0, 1)]).tell(Stopping()),
        lambda: spur_pair(module=Stopping()),
        lambda: spur_pair(pinion=gs.GearSpecification(teeth=Stopping(), face_width=1e-2, bore_radius=1e-2)),
        lambda: gs.peak_to_peak(stiffness, Stopping()),
    ):
        with pytest.raises(KeyboardInterrupt):
            call()


def test_a_design_is_for_its_pair(stiffness):
    design = gs.Design(spur_pair(module=3.1e-3), gs.TipRelief(**TIP))
    with pytest.raises(gs.InvalidInput, match="another pair"):
        gs.peak_to_peak(stiffness, 80.0, design)
    same = gs.Design(spur_pair(), gs.TipRelief(**TIP))
    assert gs.peak_to_peak(stiffness, 80.0, same) == gs.peak_to_peak(stiffness, 80.0, gs.TipRelief(**TIP))


def test_what_is_stated_does_not_change():
    relief = gs.TipRelief(**TIP)
    assert relief.amount == 12e-6 and relief.length is None
    with pytest.raises(AttributeError, match="does not change"):
        relief.amount = 20e-6
    with pytest.raises(AttributeError, match="amout"):
        relief.amout
    amounts = np.linspace(0, 1e-5, 2000)
    other = amounts.copy()
    other[1000] *= 2
    assert gs.TipRelief(gear="both", amount=amounts, fraction=1) == gs.TipRelief(gear="both", amount=amounts.copy(), fraction=1)
    assert gs.TipRelief(gear="both", amount=amounts, fraction=1) != gs.TipRelief(gear="both", amount=other, fraction=1)
    assert gs.TipRelief(gear="both", amount=amounts, fraction=1) != gs.TipRelief(gear="both", amount=1e-5, fraction=1)


def test_mesh_stiffness_is_that_of_the_torque_that_was_stated():
    pair = spur_pair()
    stated = gs.Stiffness(pair, contact="load_dependent", torque=80.0).mesh()[2]
    assert stated == gs.Stiffness(pair, contact="load_dependent").mesh(80.0)[2]
    assert stated > 1.02 * gs.Stiffness(pair, contact="load_dependent").mesh()[2]
    for wrong in ([80.0, 90.0], 0.0):
        with pytest.raises(gs.InvalidInput):
            gs.Stiffness(pair).mesh(wrong)


@pytest.mark.parametrize("torque", [5e-324, 1e-310, 1e-100])
def test_the_least_torques_come_to_an_end(stiffness, torque):
    slope = gs.HelixSlope(gear="both", amount=1e-4)
    for words in ({}, {"corner_contact": "exact"}):
        assert gs.peak_to_peak(stiffness, torque, **words) >= 0.0
        assert gs.transmission_error(stiffness, torque, slope, positions=8, **words).mean >= 0.0
    if torque < 1e-300:
        return
    logarithmic = gs.Stiffness(stiffness.pair, contact="load_dependent")
    assert gs.transmission_error(logarithmic, torque, slope, positions=8, corner_contact="exact").mean >= 0.0
