"""A search that calls a function: what :class:`gearstudy.Optimizer` is asked and told, in one call."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Sequence

from gearstudy._gearstudy import Optimizer
from gearstudy.declared import DifferentialEvolution, Search
from gearstudy.errors import RunFailed

if TYPE_CHECKING:
    import numpy
    import numpy.typing


@dataclass(frozen=True)
class Minimum:
    """What a search found."""

    point: numpy.typing.NDArray[numpy.float64]
    """One value per variable, shape (variables,)."""
    value: float
    """The objective there."""
    evaluations: int
    """Points that were looked at."""
    reason: str
    """Why it ended."""


def minimize(
    function: Callable[[Any], Any],
    bounds: Sequence[tuple[float, float]],
    *,
    method: str | Search | None = None,
    seed: int = 0,
    vectorized: bool = False,
) -> Minimum:
    """The least value of a function over a box; the same seed looks at the same points.

    Parameters
    ----------
    function : callable
        From a point of shape (variables,) to a number, NaN or infinity where there is none. With ``vectorized`` from points of
        shape (points, variables) to values of shape (points,).
    bounds : sequence of (least, most)
        One pair for each variable.
    method : str or Search, optional
        Without it: differential evolution.
    seed : int
        Where random numbers start.
    vectorized : bool
        Whether the function takes all points of a batch at once.

    Raises
    ------
    InvalidInput
        Bounds or settings that make no sense.
    RunFailed
        Where the function has no value anywhere.

    >>> import gearstudy as gs
    >>> found = gs.minimize(lambda x: (x[0] - 1) ** 2 + (x[1] + 2) ** 2, [(-5, 5), (-5, 5)])
    >>> bool(abs(found.point - [1, -2]).max() < 1e-3)
    True
    """
    box = [(float(least), float(most)) for least, most in bounds]
    search = Optimizer(DifferentialEvolution() if method is None else method, box, seed=seed)
    while not search.finished:
        points = search.ask()
        search.tell(function(points) if vectorized else [float(function(point)) for point in points])
    best = search.best
    if best is None:
        raise RunFailed("the function has no value at any point that was looked at")
    return Minimum(best.point, best.value, search.evaluations, search.reason or "")
