"""Exceptions: all of them are a :class:`GearstudyError`."""

from __future__ import annotations

from typing import Any


class GearstudyError(Exception):
    """Something that gearstudy could not do.

    ``str(error)`` is one sentence; ``help`` says what to do instead, where that is known.

    >>> str(GearstudyError("there is no such gear", help="add it"))
    'there is no such gear; add it'
    """

    def __init__(self, message: str, *, help: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.help = help

    def __str__(self) -> str:
        return self.message if self.help is None else f"{self.message}; {self.help}"

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (type(self), self.message, {k: v for k, v in self.__dict__.items() if k != "message"}))


class InvalidInput(GearstudyError, ValueError):
    """A value that makes no sense: of another type or unit, out of its range, or contradicting another one.

    >>> peak_to_peak(stiffness, "80 mm")
    Traceback (most recent call last):
        ...
    gearstudy.errors.InvalidInput: `torque` is `80 mm`; ...
    """


class InvalidStudy(GearstudyError, ValueError):
    """A text that is no study. ``file``, ``line`` and ``column`` (from 1) say where; ``mistakes`` has all that is wrong.

    >>> try:
    ...     load({"study": "empty", "stages": {"pair": {"kind": "geometri"}}})
    ... except InvalidStudy as error:
    ...     print(error.line, error.help)
    3 did you mean `geometry`?
    """

    def __init__(
        self,
        message: str,
        *,
        help: str | None = None,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        mistakes: list[dict[str, Any]] | None = None,
    ) -> None:
        super().__init__(message, help=help)
        self.file = file
        self.line = line
        self.column = column
        self.mistakes = mistakes or []

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part is not None)
        return f"{place}: {super().__str__()}" if place else super().__str__()


class RunFailed(GearstudyError, RuntimeError):
    """What was stated is sound, but cannot be computed, read or written.

    >>> gear = {"teeth": 24, "face_width": "20 mm", "bore_radius": "18 mm"}
    >>> pair = {"kind": "geometry", "module": "3 mm", "pinion": gear, "gear": gear}
    >>> load({"study": "new", "stages": {"pair": pair}}).tables["pair.gears"]
    Traceback (most recent call last):
        ...
    gearstudy.errors.RunFailed: `new` has no results yet; run it first
    """


class StudyWarning(UserWarning):
    """What a stage of a study warns of, such as a formula that is used outside its range."""


def _again(kind: type[GearstudyError], message: str, told: dict[str, Any]) -> GearstudyError:
    return kind(message, **told)
