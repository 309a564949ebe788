"""Sobol' indices of a scatter by SALib, from the same numbers: a JSON file of A, of A with each field of B, and of B."""

import json
import sys

try:
    import numpy
    from SALib.analyze import sobol
except ImportError as missing:
    print(f"\nSKIPPED: tests/python/salib_indices.py: {missing}; `pip install SALib` in .venv makes the check\n", file=sys.stderr)
    sys.exit(0)

with open(sys.argv[1], encoding="utf-8") as file:
    given = json.load(file)
fields = len(given["replaced"][0])
# Its order is A, A with each field of B, B, pair by pair.
values = [
    [own, *replaced, other]
    for own, replaced, other in zip(given["first"], given["replaced"], given["second"], strict=True)
]
problem = {"num_vars": fields, "names": [str(at) for at in range(fields)], "bounds": [[0, 1]] * fields}
found = sobol.analyze(problem, numpy.array(values).ravel(), calc_second_order=False, seed=1)
print(json.dumps({"first": found["S1"].tolist(), "total": found["ST"].tolist()}))
