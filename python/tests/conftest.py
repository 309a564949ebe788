"""What the tests share: a pair, its stiffness, and the folder of the checkout."""

import math
import os
import signal
from pathlib import Path

import pytest

import gearstudy as gs

# A job in the background of a script is started with Ctrl-C switched off, and what it starts inherits that.
signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = Path(os.environ.get("GEARSTUDY_ROOT", Path(__file__).resolve().parents[2]))


def spur_pair(**changes):
    fields = {
        "module": 3e-3,
        "pressure_angle": math.radians(20),
        "pinion": gs.GearSpecification(teeth=19, face_width=20e-3, bore_radius=14e-3),
        "gear": gs.GearSpecification(teeth=48, face_width=20e-3, bore_radius=38e-3),
    }
    return gs.Pair(**{**fields, **changes})


@pytest.fixture(scope="session")
def pair():
    return spur_pair()


@pytest.fixture(scope="session")
def stiffness(pair):
    return gs.Stiffness(pair)


@pytest.fixture(scope="session")
def relief():
    return gs.TipRelief(gear="both", amount=12e-6, fraction=0.9)


@pytest.fixture(scope="session")
def quick(tmp_path_factory):
    folder = tmp_path_factory.mktemp("quick")
    return gs.run(ROOT / "studies" / "quick.yaml", results=folder / "results", cache=folder / "cache")
