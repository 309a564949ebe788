"""Studies as the command line has them: read, planned, run, compared; their tables, verdicts and pages."""

from __future__ import annotations

import json
import os
import sys
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Callable, Sequence, Union

from gearstudy import _gearstudy
from gearstudy._gearstudy import Table
from gearstudy.errors import InvalidInput, StudyWarning

Event = dict[str, Any]
Source = Union[str, "os.PathLike[str]", Mapping[str, Any]]


class Tables(Mapping[str, Table]):
    """The published tables of a study by name, ``stage.table``; each is read when it is asked for.

    >>> "ste.summary" in study.tables
    True
    """

    def __init__(self, study: _gearstudy.Study) -> None:
        self._study = study

    def __getitem__(self, name: str) -> Table:
        return self._study._table(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._study._tables())

    def __len__(self) -> int:
        return len(self._study._tables())

    def __repr__(self) -> str:
        return f"Tables({list(self)})"


class Study(_gearstudy.Study):
    """A study, read and checked, and the results that lie in its folder; :func:`load` and :func:`run` make it.

    >>> study.tables["ste.summary"].columns[:2]
    ['design', 'torque']
    >>> {row["verdict"] for row in study.verdicts}
    {'holds'}
    """

    @property
    def tables(self) -> Tables:
        """Its published tables, ``study.tables["ste.summary"]``; :class:`RunFailed` where it was never run."""
        return Tables(self)

    @property
    def verdicts(self) -> list[dict[str, Any]]:
        """What its reports say of each number, a mapping from column to value each."""
        rows: list[dict[str, Any]] = []
        for name in self.tables:
            stage, table = name.split(".", 1)
            if table == "verdicts" and self.stages.get(stage) == "report":
                found = self.tables[name]
                columns = {column: found[column] for column in found.columns}
                rows += [{column: _plain(values[row]) for column, values in columns.items()} for row in range(len(found))]
        return rows

    def run(
        self,
        *,
        only: str | Sequence[str] = (),
        want: str | Sequence[str] = (),
        force: bool | str | Sequence[str] = False,
        jobs: int = 0,
        keep_going: bool = False,
        limit_memory: int | None = None,
        limit_rows: int | None = None,
        progress: bool | Callable[[Event], None] = False,
    ) -> Study:
        """Computes what is missing, publishes tables and page, and gives the study back; see :func:`run`.

        >>> study.run(only=["pair"]).name
        'quick'
        """
        if not (isinstance(progress, bool) or callable(progress)):
            raise InvalidInput(f"`progress` is {progress!r}; True, False or a callable is expected")
        tell = Progress() if progress is True else progress or None
        try:
            warned = self._run(
                only=_names(only),
                want=_names(want),
                force=_forced(force),
                jobs=jobs,
                keep_going=keep_going,
                limit_memory=limit_memory,
                limit_rows=limit_rows,
                progress=tell,
            )
        finally:
            if isinstance(tell, Progress):
                tell.close()
        if tell is None:
            for text in warned:
                warnings.warn(text, StudyWarning, stacklevel=_callers_level())
        return self

    def plan(
        self, *, only: str | Sequence[str] = (), want: str | Sequence[str] = (), force: bool | str | Sequence[str] = False
    ) -> dict[str, Any]:
        """What a run would do and why, as ``gearstudy plan --format json`` has it (docs/json.md).

        >>> {stage["action"] for stage in study.plan()["stages"]}
        {'hit'}
        """
        return self._plan(only=_names(only), want=_names(want), force=_forced(force))

    def diff(self, before: Study) -> dict[str, Any]:
        """What differs between the results of another study and those of this one, as ``gearstudy diff --format json``.

        >>> study.diff(study)["state"]
        'same'
        """
        return self._diff(before)

    def _repr_html_(self) -> str:
        page = self.report
        link = f'<a href="{page.resolve().as_uri()}">{page}</a>' if page else "no page yet"
        return f"<b>{self.name}</b>: {_escaped(self.title)}, {len(self.stages)} stages; {link}"


def load(
    study: Source,
    *,
    set: Mapping[str, Any] | None = None,
    name: str | None = None,
    results: str | os.PathLike[str] = "results",
    cache: str | os.PathLike[str] | None = None,
) -> Study:
    """Reads and checks a study without running it.

    Parameters
    ----------
    study : path or mapping
        A YAML file, or what such a file says as nested mappings and lists.
    set : mapping, optional
        Values for paths of fields, ``{"ste.torque": "80 N m"}``; as ``--set`` of the command line, it renames the study.
    name : str, optional
        How it is called then.
    results, cache : path
        Where results and computed tables lie; the cache is that of the command line unless it is named.

    Raises
    ------
    InvalidStudy
        With file, line and column, and in ``mistakes`` all that is wrong.

    >>> gear = {"teeth": 24, "face_width": "20 mm", "bore_radius": "18 mm"}
    >>> pair = {"kind": "geometry", "module": "3 mm", "pinion": gear, "gear": gear}
    >>> load({"study": "drawn", "stages": {"pair": pair}}).stages
    {'pair': 'geometry'}
    >>> load({"study": "drawn", "stages": {"pair": {**pair, "modul": "3 mm"}}})
    Traceback (most recent call last):
        ...
    gearstudy.errors.InvalidStudy: ...
    """
    text, path = (_text(study), Path("study.yaml")) if isinstance(study, Mapping) else (None, Path(study))
    if not isinstance(set or {}, Mapping):
        raise InvalidInput(f"`set` is {set!r}; a mapping from paths to values is expected")
    changes = [f"{path}={_written(value)}" for path, value in (set or {}).items()]
    # Where they lie now: the process may go elsewhere before it is run.
    kept = None if cache is None else Path(cache).absolute()
    return Study(text, path, set=changes, name=name, results=Path(results).absolute(), cache=kept)


def run(
    study: Source,
    *,
    set: Mapping[str, Any] | None = None,
    name: str | None = None,
    results: str | os.PathLike[str] = "results",
    cache: str | os.PathLike[str] | None = None,
    only: str | Sequence[str] = (),
    want: str | Sequence[str] = (),
    force: bool | str | Sequence[str] = False,
    jobs: int = 0,
    keep_going: bool = False,
    limit_memory: int | None = None,
    limit_rows: int | None = None,
    progress: bool | Callable[[Event], None] = False,
) -> Study:
    """Runs a study as ``gearstudy run`` does: what is up to date is not computed again.

    Parameters
    ----------
    study, set, name, results, cache
        As :func:`load` has them.
    only : str or sequence of str
        These stages and what they need.
    want : str or sequence of str
        Tables and columns on demand, ``stage.table`` or ``stage.table.column``.
    force : bool, str or sequence of str
        Whether all, or which stages, are computed although they are known.
    jobs : int
        Threads; 0 for as many as the machine has. They change no bit of any result.
    keep_going : bool
        Whether stages that do not depend on one that failed are still run.
    limit_memory, limit_rows : int, optional
        Bytes and rows beyond which a run is refused before it starts.
    progress : bool or callable
        ``True`` shows lines (a bar in a notebook); a callable is given each event as a mapping (docs/json.md). What it raises
        stops the run.

    Raises
    ------
    InvalidStudy, RunFailed
        What is wrong; what is finished is kept.
    KeyboardInterrupt
        Ctrl-C; what is finished is kept, and the next run goes on from there.

    Warns
    -----
    StudyWarning
        What a stage warns of, unless ``progress`` tells it.

    >>> gear = {"teeth": 24, "face_width": "20 mm", "bore_radius": "18 mm"}
    >>> pair = {"kind": "geometry", "module": "3 mm", "pinion": gear, "gear": gear}
    >>> drawn = run({"study": "drawn", "stages": {"pair": pair}}, set={"pair.gear.teeth": 36}, results=folder, cache=folder / "cache")
    >>> gears = drawn.tables["pair.gears"]
    >>> gears["gear"], gears["teeth"]
    (['gear', 'pinion'], array([36, 24]))
    """
    read = load(study, set=set, name=name, results=results, cache=cache)
    return read.run(
        only=only,
        want=want,
        force=force,
        jobs=jobs,
        keep_going=keep_going,
        limit_memory=limit_memory,
        limit_rows=limit_rows,
        progress=progress,
    )


def _callers_level() -> int:
    """How far above whoever asks the first code is that is not of this package: where a warning belongs."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").split(".")[0] == __package__:
        level, frame = level + 1, frame.f_back
    return level


class Progress:
    """Shows how a run goes on: a line that changes in a notebook, lines on standard error elsewhere."""

    def __init__(self) -> None:
        self._display: Any = None
        if "ipykernel" in sys.modules:
            from IPython.display import display

            self._display = display({"text/plain": ""}, raw=True, display_id=True)  # type: ignore[no-untyped-call]
        self._done = 0

    def __call__(self, event: Event) -> None:
        stage, kind = event.get("stage"), event["event"]
        if kind == "stage" and event["state"] in ("done", "hit", "failed", "skipped"):
            self._done += 1
            self._show(f"{stage}: {event['state']}", lasting=event["state"] != "hit")
        elif kind == "progress":
            self._show(f"{stage}: {event['share']:.0%}", lasting=False)
        elif kind == "warning":
            self._show(f"warning: {stage + ': ' if stage else ''}{event['message']}", lasting=True)

    def _show(self, text: str, *, lasting: bool) -> None:
        if self._display is not None:
            self._display.update({"text/plain": f"{self._done} stages; {text}"}, raw=True)
        elif lasting:
            print(text, file=sys.stderr)

    def close(self) -> None:
        if self._display is not None:
            self._display.update({"text/plain": f"{self._done} stages looked at"}, raw=True)


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else value


def _text(study: Mapping[str, Any]) -> str:
    """A mapping as YAML: keys and stages on lines of their own, what is inside them as JSON, which YAML is too."""
    lines = []
    try:
        for key, value in study.items():
            if key == "stages" and isinstance(value, Mapping) and value:
                lines.append("stages:")
                lines += [f"  {_json(name)}: {_json(stage)}" for name, stage in value.items()]
            else:
                lines.append(f"{_json(key)}: {_json(value)}")
        text = "\n".join(lines) + "\n"
        text.encode()
    except (TypeError, ValueError, RecursionError) as error:
        raise InvalidInput(f"the mapping cannot be a study: {error}") from error
    return text


def _json(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, default=_of_numpy)


def _of_numpy(value: Any) -> Any:
    """An array or a number of numpy as Python's own."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{value!r} of type {type(value).__name__} is nothing that a study can say")


def _written(value: Any) -> str:
    """A value as a study writes it."""
    try:
        return value if isinstance(value, str) else _json(value)
    except (TypeError, ValueError, RecursionError) as error:
        raise InvalidInput(f"`set` has a value that no study can have: {error}") from error


def _names(names: str | Sequence[str]) -> list[str]:
    return [names] if isinstance(names, str) else list(names)


def _forced(force: bool | str | Sequence[str]) -> bool | list[str]:
    # A flag of numpy is one, too.
    return bool(force) if isinstance(force, bool) or hasattr(force, "dtype") else _names(force)


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
