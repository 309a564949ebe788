"""Puts fronts beside those of pymoo's NSGA-II, on pymoo's own problems, all measured by pymoo's hypervolume.

    python fronts.py FRONTS.json
"""

import json
import pathlib
import sys

try:
    import numpy
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.indicators.hv import HV
    from pymoo.optimize import minimize
    from pymoo.problems import get_problem
except ImportError:
    print("SKIPPED: there is no `pymoo` in this Python; `make setup` installs it")
    sys.exit()

given = json.loads(pathlib.Path(sys.argv[1]).read_text())
for problem in given["problems"]:
    name, reference = problem["name"], numpy.array(problem["reference"])
    theirs = get_problem(name, n_var=12, n_obj=3) if name == "dtlz2" else get_problem(name)
    low, high = theirs.bounds()
    assert problem["bounds"] == [[float(a), float(b)] for a, b in zip(low, high)], (name, low, high)
    # The same functions, and the same constraints but for their scale.
    told = theirs.evaluate(numpy.array([probe["point"] for probe in problem["probes"]]), return_as_dictionary=True)
    for row, probe in enumerate(problem["probes"]):
        assert numpy.allclose(told["F"][row], probe["objectives"], rtol=1e-12, atol=1e-12), (name, row)
        if theirs.n_constr:
            kept, ours = told["G"][row] <= 0.0, numpy.array(probe["constraints"]) >= 0.0
            assert (kept == ours).all(), (name, row, told["G"][row], probe["constraints"])
    volume = HV(ref_point=reference)
    # Their hypervolume of our fronts is ours.
    for front, ours in zip(problem["fronts"], problem["hypervolumes"]):
        assert abs(volume(numpy.array(front)) / ours - 1.0) < 1e-12, (name, ours)
    settings = ("n_gen", given["generations"])
    runs = [minimize(theirs, NSGA2(pop_size=given["population"]), settings, seed=seed) for seed in (1,)]
    peer = sum(volume(run.F) for run in runs) / len(runs)
    ours = sum(problem["hypervolumes"]) / len(problem["hypervolumes"])
    print(f"{name}: {ours / problem['exact']:.5f} of the exact hypervolume, pymoo {peer / problem['exact']:.5f}")
    assert ours > 0.995 * peer, (name, ours, peer)
