"""Types, as two checkers read them."""

import subprocess
import sys
from pathlib import Path

import pytest

import gearstudy
from conftest import ROOT

PACKAGE = Path(gearstudy.__file__).parent
USE = '''
import numpy as np
import gearstudy as gs

gear = gs.GearSpecification(teeth=24, face_width=20e-3, bore_radius="18 mm")
pair: gs.Pair = gs.Pair(module=3e-3, pinion=gear, gear=gear)
stiffness = gs.Stiffness(pair, method=gs.FiniteElement(elements_across=8), coupling="body")
relief = gs.TipRelief(gear="both", amount=np.array([1e-6]), fraction=0.5)
curve: gs.TransmissionError = gs.transmission_error(stiffness, 80.0, [relief], corner_contact="exact")
peak: float = curve.peak_to_peak
study: gs.Study = gs.run({"study": "a", "stages": {}}, progress=print)
'''
WRONG = '''
import gearstudy as gs

gs.TipRelief(gear="bth", amount=1e-6)
gs.GearSpecification(teeth=24)
gs.Pair(modul=3e-3)
'''


def test_mypy(tmp_path):
    pytest.importorskip("mypy")
    own = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", str(ROOT / "python" / "pyproject.toml"), "-p", "gearstudy"],
        cwd=PACKAGE.parent, capture_output=True, text=True,
    )
    assert own.returncode == 0, own.stdout
    (tmp_path / "use.py").write_text(USE)
    (tmp_path / "wrong.py").write_text(WRONG)
    words = [sys.executable, "-m", "mypy", "--strict"]
    said = subprocess.run([*words, "use.py"], cwd=tmp_path, capture_output=True, text=True)
    assert said.returncode == 0, said.stdout
    said = subprocess.run([*words, "wrong.py"], cwd=tmp_path, capture_output=True, text=True)
    assert said.stdout.count(": error:") >= 3, said.stdout


def test_pyright(tmp_path):
    pyright = Path(sys.executable).parent / "pyright"
    # It brings its program along when it is first started, which the set-up does.
    started = pyright.exists() and subprocess.run([pyright, "--version"], capture_output=True).returncode == 0
    if not started:
        print("SKIPPED: python/tests/test_types.py: pyright does not start; `make setup` installs it", file=sys.__stderr__)
        pytest.skip("pyright does not start")
    for text, wrong in ((USE, 0), (WRONG, 3)):
        (tmp_path / "use.py").write_text(text)
        said = subprocess.run([pyright, "--pythonpath", sys.executable, "use.py"], cwd=tmp_path, capture_output=True, text=True)
        assert said.stdout.count(" error: ") >= wrong and (wrong > 0 or said.returncode == 0), said.stdout
