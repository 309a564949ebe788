"""Values that `reference.rs` beside this compares with, from SciPy and from an independent genetic algorithm.

    pip install scipy==1.17.1 && python reference.py > reference.json
"""

import json

import numpy as np
from scipy.optimize import Bounds, differential_evolution, minimize
from scipy.stats import qmc


def rosenbrock(x):
    """Over -2..2 in each variable; x is a point of the unit cube."""
    total = 0.0
    y = [-2.0 * (1.0 - t) + 2.0 * t for t in x]
    for a, b in zip(y, y[1:]):
        total += 100.0 * ((b - a * a) * (b - a * a)) + (1.0 - a) * (1.0 - a)
    return total


def slope(x):
    """Lowest at a corner of the cube."""
    total = 0.0
    for k, t in enumerate(x):
        total += (k + 1.0) * t + (t - 0.3) * (t - 0.3)
    return total


def corners(x):
    """A kink in every variable, at 0.7."""
    total = 0.0
    for k, t in enumerate(x):
        total += (k + 1.0) * abs(t - 0.7)
    return total


def bent(x):
    """Smooth, not quadratic, with every variable tied to the next; its lowest point is on no bound."""
    total = 0.0
    for k, t in enumerate(x):
        u = x[k + 1] if k + 1 < len(x) else x[0]
        total += (k + 1.0) * (t - 0.2 * (k + 1.0)) ** 2 + (t * u - 0.3) ** 2
    return total


def steps(x):
    """Flat nearly everywhere: ties decide."""
    total = 0.0
    for t in x:
        total += np.floor(50.0 * abs(t - 0.7))
    return total


def simplex():
    rows = []
    for name, function, dimension in [
        ("rosenbrock", rosenbrock, 2),
        ("rosenbrock", rosenbrock, 5),
        ("slope", slope, 3),
        ("corners", corners, 2),
        ("corners", corners, 4),
        ("steps", steps, 2),
        ("steps", steps, 3),
    ]:
        start = np.full(dimension, 0.5)
        first = np.vstack([start] + [start + 0.1 * unit for unit in np.eye(dimension)])
        found = minimize(
            function,
            start,
            method="Nelder-Mead",
            bounds=Bounds(np.zeros(dimension), np.ones(dimension)),
            options=dict(initial_simplex=first, adaptive=True, xatol=1e-8, fatol=np.inf, maxfev=5000, maxiter=5000),
        )
        rows.append(
            dict(function=name, dimension=dimension, evaluations=found.nfev, value=found.fun, point=list(found.x))
        )
    return rows


def directions():
    """Powell's method; its way depends on the line search, so only where it ends is compared. SciPy's search between
    bounds stops early in the valley of the first function, which has its minimum inside: there it is given none."""
    rows = []
    for name, function, dimension in [
        ("rosenbrock", rosenbrock, 2),
        ("rosenbrock", rosenbrock, 3),
        ("rosenbrock", rosenbrock, 5),
        ("slope", slope, 3),
        ("corners", corners, 4),
        ("bent", bent, 4),
    ]:
        found = minimize(
            function,
            np.full(dimension, 0.5),
            method="Powell",
            bounds=None if name == "rosenbrock" else Bounds(np.zeros(dimension), np.ones(dimension)),
            options=dict(xtol=1e-12, ftol=1e-15),
        )
        rows.append(
            dict(function=name, dimension=dimension, evaluations=found.nfev, value=found.fun, point=list(found.x))
        )
    return rows


def generations(function, dimension, seed, target):
    """Generations that rand/1/bin takes until the best value is below the target, which lies far from all bounds: there
    SciPy draws anew what ours reflects."""
    count = 0

    def stop(intermediate_result):
        nonlocal count
        count += 1
        return intermediate_result.fun < target

    differential_evolution(
        function,
        [(0.0, 1.0)] * dimension,
        strategy="rand1bin",
        maxiter=2000,
        popsize=10,
        tol=0.0,
        mutation=0.7,
        recombination=0.9,
        rng=seed,
        callback=stop,
        polish=False,
        updating="deferred",
    )
    return count


def evolution():
    rows = []
    for name, function, dimension, target in [("corners", corners, 3, 1e-4), ("rosenbrock", rosenbrock, 3, 1e-6)]:
        counts = [generations(function, dimension, seed, target) for seed in range(101)]
        rows.append(
            dict(
                function=name,
                dimension=dimension,
                population=10 * dimension,
                target=target,
                runs=len(counts),
                mean=float(np.mean(counts)),
                deviation=float(np.std(counts, ddof=1)),
            )
        )
    return rows


def bowl(x):
    """Positive, lowest 0.1 between two values of the code; x has one row per individual."""
    return 0.1 + ((x - np.array([0.3, 0.62, 0.81])) ** 2).sum(axis=1)


def genetic_run(rng, size=100, length=30, per_generation=100, gene=10):
    """Best value of each generation."""
    people = rng.integers(0, 2, size=(size, length))
    weights = 2 ** np.arange(gene)[::-1]
    best = []
    for _ in range(per_generation):
        values = bowl(people.reshape(size, length // gene, gene) @ weights / (2**gene - 1))
        best.append(values.min())
        fitness = 1.0 / values
        parents = people[rng.choice(size, size=size, p=fitness / fitness.sum())]
        children = parents.copy()
        for pair in range(0, size, 2):
            if rng.random() < 0.5:
                cut = rng.integers(1, length)
                children[pair, cut:], children[pair + 1, cut:] = parents[pair + 1, cut:], parents[pair, cut:]
        for child in children:
            if rng.random() < 0.5:
                child[rng.integers(length)] ^= 1
        people = children
    return best


def genetic(runs=400):
    best = np.array([genetic_run(np.random.default_rng(seed)) for seed in range(runs)])
    so_far = np.minimum.accumulate(best, axis=1)
    rows = []
    for generation in (1, 10, 100):
        for name, values in (("best", best), ("best_so_far", so_far)):
            # The excess over the minimum is skewed; its logarithm has a useful mean.
            excess = np.log(values[:, generation - 1] - 0.1)
            rows.append(
                dict(
                    generation=generation,
                    of=name,
                    runs=runs,
                    mean=float(excess.mean()),
                    deviation=float(excess.std(ddof=1)),
                )
            )
    return rows


def sobol():
    """In 64ths, which the first 64 points are whole numbers of."""
    return (64 * qmc.Sobol(d=16, scramble=False).random(64)).astype(int).tolist()


def write(tables):
    """JSON with one row to a line."""
    texts = []
    for name, rows in tables.items():
        texts.append(f' "{name}": [\n  ' + ",\n  ".join(json.dumps(row) for row in rows) + "\n ]")
    print("{\n" + ",\n".join(texts) + "\n}")


write(dict(nelder_mead=simplex(), powell=directions(), differential_evolution=evolution(), genetic=genetic(), sobol=sobol()))
