"""W_k and M_dK measured on flanks that py_gearworks draws, from a JSON file of gears; lengths in modules.

py_gearworks 0.0.24 has no such measurements. It finds where an involute crosses the pitch circle and turns it to the tooth's
thickness; here two planes and two balls are laid against those curves. Its package imports a kernel of solids, which
nothing of this needs: `build123d` and the module that builds solids are empty here. Nothing else of it is changed.
"""

import importlib.util
import json
import math
import sys
from types import ModuleType
from unittest.mock import MagicMock

found = importlib.util.find_spec("py_gearworks")
if found is None:
    print(
        "\nSKIPPED: tests/python/gearworks_flanks.py: no py_gearworks; `pip install --no-deps py_gearworks` in .venv makes the check\n",
        file=sys.stderr,
    )
    sys.exit(0)
package = ModuleType("py_gearworks")
package.__path__ = list(found.submodule_search_locations)
solids = ModuleType("py_gearworks.conv_build123d")
solids.bd, solids.GearBuilder = MagicMock(), object
sys.modules |= {"py_gearworks": package, "build123d": MagicMock(), "py_gearworks.conv_build123d": solids}

from py_gearworks.wrapper import SpurGear  # noqa: E402
from scipy.optimize import minimize_scalar  # noqa: E402

with open(sys.argv[1], encoding="utf-8") as file:
    given = json.load(file)


def largest(flank, of):
    """The largest value of points of a flank, which must not be at an end of it."""
    steps = [flank.t_0 + (flank.t_1 - flank.t_0) * step / 12 for step in range(13)]
    values = [of(*flank.function(at)[:2]) for at in steps]
    best = values.index(max(values))
    within = minimize_scalar(
        lambda at: -of(*flank.function(at)[:2]), bounds=(steps[max(best - 1, 0)], steps[min(best + 1, 12)]),
        method="bounded", options={"xatol": 1e-8},
    )
    if not flank.t_0 + 1e-6 < within.x < flank.t_1 - 1e-6:
        raise ValueError(f"touched at an end of the flank: {within.x}")
    return -within.fun


def aside(angle):
    """How far to the side a point is once the tooth is turned by an angle."""
    return lambda x, y: -x * math.sin(angle) - y * math.cos(angle)


def held(angle, radius):
    """How far out along a centreline at an angle the centre of a ball is that lies on a point; 0 for one it does not reach."""
    cosine, sine = math.cos(angle), math.sin(angle)

    def centre(x, y):
        along, away = x * cosine + y * sine, y * cosine - x * sine
        return along + math.sqrt(radius**2 - away**2) if abs(away) < radius else 0.0

    return centre


answers = []
for own in given:
    teeth, diameter = own["teeth"], own["ball_diameter"]
    gear = SpurGear(
        number_of_teeth=teeth, profile_shift=own["profile_shift"], pressure_angle=own["pressure_angle"],
        backlash=own["backlash"], enable_undercut=False,
    )
    # From the base circle up; the centreline of the tooth is the first axis, and the flank on the negative side of it.
    _, flank = gear.gearcore.shape_recipe(0).tooth_generator.generate_involute_curve()
    half_pitch = math.pi / teeth
    # The last of k teeth, the first axis being the centreline of them all.
    span = 2.0 * largest(flank, aside(-(own["span_teeth"] - 1) * half_pitch))
    centre = largest(flank, held(-half_pitch, 0.5 * diameter))
    # The other ball is in the space that is farthest away.
    apart = max(2.0 * centre * math.sin(space * half_pitch) for space in range(1, teeth))
    answers.append({"span": span, "over_two": apart + diameter})
print(json.dumps(answers))
