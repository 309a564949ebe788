"""Spur gears with modified teeth: stiffness, transmission error, reliefs, and reproducible studies of them.

Kernels take SI numbers and numpy arrays; names are those of ISO 21771 and ISO 6336, and those of a study's fields.

>>> import gearstudy as gs
>>> pair = gs.Pair(
...     module=3e-3,
...     pinion=gs.GearSpecification(teeth=24, face_width=20e-3, bore_radius=18e-3),
...     gear=gs.GearSpecification(teeth=36, face_width=20e-3, bore_radius=28e-3),
... )
>>> stiffness = gs.Stiffness(pair)
>>> relief = gs.TipRelief(gear="both", amount=14e-6, fraction=0.8)
>>> curve = gs.transmission_error(stiffness, 150.0, relief)
>>> curve.peak_to_peak < 0.2 * gs.peak_to_peak(stiffness, 150.0)
True

Examples elsewhere take ``pair``, ``stiffness`` and ``relief`` from here, and the names of the package as they are.

Studies are run as the command line runs them:

>>> study = gs.run("studies/quick.yaml")                      # doctest: +SKIP
>>> study.tables["ste.summary"]["peak_to_peak"]               # doctest: +SKIP
"""

from gearstudy._gearstudy import (
    Candidate,
    Design,
    GearFacts,
    Optimizer,
    Table,
    TransmissionError,
    __version__,
    peak_to_peak,
    summaries,
    transmission_error,
)
from gearstudy import declared
from gearstudy.declared import *  # noqa: F403
from gearstudy.errors import GearstudyError, InvalidInput, InvalidStudy, RunFailed, StudyWarning
from gearstudy.searching import Minimum, minimize
from gearstudy.studies import Progress, Study, Tables, load, run

__all__ = [
    "Candidate",
    "Design",
    "GearFacts",
    "GearstudyError",
    "InvalidInput",
    "InvalidStudy",
    "Minimum",
    "Optimizer",
    "Progress",
    "RunFailed",
    "Study",
    "StudyWarning",
    "Table",
    "Tables",
    "TransmissionError",
    "__version__",
    "load",
    "minimize",
    "peak_to_peak",
    "run",
    "summaries",
    "transmission_error",
]
__all__ += declared.__all__
