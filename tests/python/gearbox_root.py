"""Y_F, Y_S and σ_F0 of pairs by python-gearbox, from a JSON file of pairs; lengths in modules, loads in N/mm of a module of 1 mm.

In python-gearbox 0.1.2 `involute` takes degrees, and where γ_e is found it is given radians: with what it makes of them Y_F is
5 % off. It is given one here that takes radians. Nothing else of it is changed.
"""

import json
import math
import sys
import warnings
from types import SimpleNamespace

warnings.simplefilter("ignore")  # It compares numbers with `is`.
try:
    from gearbox.standards import iso
except ImportError as missing:
    print(
        f"\nSKIPPED: tests/python/gearbox_root.py: {missing}; `pip install --pre python-gearbox` in .venv makes the check\n",
        file=sys.stderr,
    )
    sys.exit(0)

iso.involute = lambda angle: math.radians(math.tan(angle) - angle)

with open(sys.argv[1], encoding="utf-8") as file:
    given = json.load(file)


def gear(pair, at):
    teeth = pair["teeth"][at]
    rack = SimpleNamespace(ha_p=pair["addendum"], hf_p=pair["dedendum"], rho_fp=pair["tip_radius"])
    height = pair["addendum"] + pair["dedendum"]
    return SimpleNamespace(
        z=teeth, zn=float(teeth), x=pair["profile_shift"][at], m=1.0, alpha=pair["pressure_angle"], beta=0.0, beta_b=0.0,
        profile=rack, h=height, sr=10.0 * height, precision_grade=6,
    )


answers = []
for pair in given:
    both = [gear(pair, at) for at in range(2)]
    mesh = SimpleNamespace(
        gear_one=both[0], gear_two=both[1], epsilon_alpha=pair["contact_ratio"], epsilon_beta=0.0, ft=pair["load"]
    )
    bending = iso.Bending(mesh)
    forms, notches = bending._Bending__yf(mesh), bending._Bending__ys(mesh)
    common = bending._Bending__ybeta(mesh) * bending._Bending__ydt(mesh)
    stresses = [
        mesh.ft / pair["width"] * form * notch * common * bending._Bending__yb(own)
        for form, notch, own in zip(forms, notches, both, strict=True)
    ]
    answers.append({"form": forms, "notch": notches, "stress": stresses})
print(json.dumps(answers))
