"""Fits of many curves in one folder: table, JSON, pictures; what the folder has is not computed again."""

from __future__ import annotations

import json
import os
import re
from collections import Counter
from collections.abc import Generator, Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from functools import lru_cache
from hashlib import file_digest, sha256
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from comparisons.console.progress import counting
from comparisons.data.input_files import LARGEST_ROWS, regular_file
from comparisons.fitting.fit import Fit, checked_keys, fit_record
from comparisons.fitting.maps import draw_map
from comparisons.fitting.pictures import draw
from comparisons.fitting.reading import Curve, curves_in
from comparisons.fitting.record import Spot
from comparisons.fitting.table import fit_table
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.output.latex import latex
from comparisons.output.style import save
from comparisons.problem import Problem
from comparisons.runs.atomic_files import prepare_folder, write_file
from comparisons.runs.csv_format import csv_text
from comparisons.runs.folder_lock import locked
from comparisons.runs.store import Form, Store
from comparisons.runs.workers import LOST, each

#: Most curves of which each has a picture unless more are asked for: a picture takes a third of a second.
MOST_PICTURES = 50

#: What is stored of a curve: its name and the digest of all that determines its fit, and this or why there is none.
_FORM: Form[dict[str, Any]] = Form("fits", key=lambda item: [item["curve"], item["digest"]], read=dict, write=dict)


@dataclass(frozen=True)
class _Task:
    """One curve to fit: number `number` of a file."""

    path: Path
    file: str
    number: int
    curve: str
    spot: Spot
    content: str
    picture: Path | None
    problem: Problem
    free: Sequence[str]
    options: Mapping[str, Any]

    @property
    def key(self) -> tuple[str, str]:
        """Name, and digest of the file, the problem and the options."""
        text = json.dumps([self.content, self.problem.digest, list(self.free), dict(self.options)], default=repr)
        return self.curve, sha256(text.encode()).hexdigest()


class _Outcome(NamedTuple):
    """What is stored of a curve, and the sentence that refuses it, which is not stored: empty where it can be used."""

    item: dict[str, Any]
    refusal: str = ""


def fit_files(
    paths: Sequence[Path],
    problem: Problem,
    free: Sequence[str],
    folder: Path | None,
    jobs: int = 1,
    *,
    pictures: bool = False,
    **options: Any,
) -> list[dict[str, Any]]:
    """Fit every curve of some files, in parallel.

    Parameters
    ----------
    paths : sequence of Path
    problem, free
        As of `comparisons.fitting.fit.fit`.
    folder : Path, optional
        Which keeps each fit with its picture as soon as it exists, and gets fits.json, fits.csv, fits.tex, and a
        picture of each map.
    jobs : int
        Number of processes.
    pictures : bool
        Whether each curve has a picture even if there are more than `MOST_PICTURES`.
    **options
        Of `fit`.

    Returns
    -------
    list of dict
        For each curve, and each file that cannot be read, ``file``, ``curve``, ``position`` (``x``, ``y`` in m,
        ``column``, ``row``), ``fits`` with its fit as of `Fit.as_json`, and ``failure``, empty where it has one.

    Raises
    ------
    ValueError
        If a key or an option cannot be used, none of the curves can, or another process computes into the folder.
    comparisons.model.ComputationFailed
        If the workers cannot compute.
    """
    checked_keys(problem, free, options.get("model"))
    names = names_by_path(paths)
    refusals: list[_Outcome] = []
    tasks = {task.key: task for task in _tasks(names, folder, refusals, problem, free, options, pictures)}
    # One curve is fitted sooner than a process has started.
    jobs = min(jobs, max(len(tasks), 1))
    if folder is None:
        with counting("fits", len(tasks)) as advance:
            items = []
            for item in _sound(each(_fitted, [*tasks.values()], jobs, lost=_lost), refusals):
                items.append(item)
                advance()
        return _sorted(items, refusals)
    with locked(prepare_folder(folder)):
        with Store(folder, _FORM) as store:
            missing = _missing(tasks, store.items)
            store.complete("fits", len(missing), _sound(each(_fitted, missing, jobs, lost=_lost), refusals))
            items = [item for item in store.items if (item["curve"], item["digest"]) in tasks]
        items = _sorted(items, refusals)
        _write(folder, items, free, _pictures(names, folder))
    return items


def names_by_path(paths: Sequence[Path]) -> dict[str, Path]:
    """Return files by the shortest ends of their paths that differ where files have one name, each file once.

    Examples
    --------
    >>> list(names_by_path([Path("a/c.csv"), Path("b/c.csv"), Path("a/d.csv"), Path("a/d.csv")]))
    ['a/c.csv', 'b/c.csv', 'd.csv']
    """
    parts = {PurePath(os.path.abspath(path)).parts[1:]: path for path in paths}
    names: dict[tuple[str, ...], str] = {}
    for count in range(1, max(map(len, parts), default=0) + 1):
        # The names of two files differ by more than the case of their letters, which some disks ignore.
        ends = {own: "/".join(own[-count:]) for own in parts}
        users = Counter(end.casefold() for end in ends.values())
        for own, end in ends.items():
            if own not in names and (users[end.casefold()] == 1 or count >= len(own)):
                names[own] = end
    return {names[own]: path for own, path in parts.items()}


def _tasks(
    names: Mapping[str, Path],
    folder: Path | None,
    refusals: list[_Outcome],
    problem: Problem,
    free: Sequence[str],
    options: Mapping[str, Any],
    pictures: bool,
) -> list[_Task]:
    """Return the curves of all files; a file that cannot be read is refused."""
    files: dict[str, tuple[str, list[Curve]]] = {}
    for name, path in names.items():
        try:
            content = _content(path)
            files[name] = content, curves_in(path, name, **_instrument(options))
        except ValueError as refusal:
            item = _item(name, name, Spot(), "", _without_path(refusal, path))
            refusals.append(_Outcome(item, str(refusal)))
    has_pictures = folder is not None and (
        pictures or sum(len(curves) for _, curves in files.values()) <= MOST_PICTURES
    )
    stems = _pictures(names, folder) if folder is not None and has_pictures else {}
    tasks = []
    for name, (content, curves) in files.items():
        for number, curve in enumerate(curves, start=1):
            stem = stems.get(name)
            picture = None if stem is None else Path(f"{stem}-{number}.png" if len(curves) > 1 else f"{stem}.png")
            shared = content, picture, problem, free, options
            tasks.append(_Task(names[name], name, number, curve.name, curve.spot, *shared))
    return tasks


def _content(path: Path) -> str:
    """The digest of a file, which may be as large as a map."""
    try:
        with regular_file(path, LARGEST_ROWS) as (file, _):
            return file_digest(file, "sha256").hexdigest()  # type: ignore[arg-type]  # a file in binary mode
    except OSError as error:
        raise ValueError(f"{path} cannot be read ({error.strerror}); check the name") from None


def _instrument(options: Mapping[str, Any]) -> dict[str, Any]:
    return {name: options.get(name) for name in ("stiffness", "sensitivity")}


def _missing(tasks: Mapping[tuple[str, str], _Task], items: Iterable[Mapping[str, Any]]) -> list[_Task]:
    """Return the curves without a fit or a reason, and those that lack their picture."""
    stored = {(item["curve"], item["digest"]): item for item in items}

    def is_complete(key: tuple[str, str], task: _Task) -> bool:
        return key in stored and (task.picture is None or task.picture.exists() or not stored[key]["fits"])

    return [task for key, task in tasks.items() if not is_complete(key, task)]


def _pictures(names: Iterable[str], folder: Path) -> dict[str, Path]:
    """Return the picture of each file without its ending: that of its name if no other file has the same."""
    stems = {name: PurePath(name).with_suffix("").as_posix() for name in names}
    users = Counter(stem.casefold() for stem in stems.values())
    # The pictures of a file of several curves end in a number or in "map", as a name may.
    without_end = {stem: re.sub(r"-(\d+|map)$", "", stem) for stem in users}
    shared = {name for stem, name in without_end.items() if stem != name and name in users}
    alone = {stem for stem in users if users[stem] == 1 and without_end[stem] not in shared}
    return {name: folder / (stem if stem.casefold() in alone else name) for name, stem in stems.items()}


def _sound(outcomes: Generator[_Outcome], refusals: list[_Outcome]) -> Generator[dict[str, Any]]:
    """Yield what is stored, and keep the others."""
    with closing(outcomes):
        for outcome in outcomes:
            if outcome.refusal:
                refusals.append(outcome)
            else:
                yield outcome.item


def _sorted(items: Sequence[dict[str, Any]], refusals: Sequence[_Outcome]) -> list[dict[str, Any]]:
    """Return all items; `ValueError` if no curve can be used."""
    if refusals and not items:
        others = f"; none of the {len(refusals)} curves can be used" if len(refusals) > 1 else ""
        raise ValueError(refusals[0].refusal + others)
    return sorted([*items, *(refused.item for refused in refusals)], key=_place)


def _place(item: Mapping[str, Any]) -> tuple[str, int, str]:
    """The order of a curve: by file, and by its number in it."""
    name, _, number = str(item["curve"]).rpartition("#")
    return str(item["file"]), int(number) if name and number.isdecimal() else 0, str(item["curve"])


def _item(file: str, curve: str, spot: Spot, digest: str, failure: str, fits: Sequence[Fit] = ()) -> dict[str, Any]:
    """Return what is stored of a curve."""
    return {
        "file": file,
        "curve": curve,
        "position": asdict(spot),
        "digest": digest,
        "fits": [fitted.as_json() for fitted in fits],
        "failure": failure,
    }


def _of_task(task: _Task, failure: str, fits: Sequence[Fit] = ()) -> dict[str, Any]:
    return _item(task.file, *(task.curve, task.spot), task.key[1], failure, fits)


def _lost(task: _Task) -> _Outcome:
    return _Outcome(_of_task(task, LOST))


def _fitted(task: _Task) -> _Outcome:
    """Fit a curve; one that cannot be used costs its own fit alone."""
    of_fit = {name: value for name, value in task.options.items() if name not in _instrument(task.options)}
    try:
        curves = _curves(task.path, task.file, task.content, *_instrument(task.options).values())
        record = curves[task.number - 1].read()
        keys = checked_keys(task.problem, task.free, of_fit.get("model"))
        fitted = fit_record(record, task.problem, keys, **of_fit)
    except (ComputationFailed, NotApplicable) as failure:
        return _Outcome(_of_task(task, _without_path(failure, task.path)))
    except ValueError as refusal:
        return _Outcome(_of_task(task, _without_path(refusal, task.path)), str(refusal))
    if task.picture is not None:
        task.picture.parent.mkdir(parents=True, exist_ok=True)
        save(draw(fitted), task.picture)
    return _Outcome(_of_task(task, "", [fitted]))


@lru_cache(maxsize=1)
def _curves(path: Path, name: str, content: str, stiffness: Any, sensitivity: Any) -> list[Curve]:
    """Return the curves of a file of some content: a process opens a map once."""
    return curves_in(path, name, stiffness, sensitivity)


def _without_path(error: Exception, path: Path) -> str:
    """Return a sentence without the path of the file, which stands before it already."""
    return str(error).removeprefix(str(path)).lstrip(":, ")


def _write(folder: Path, items: Sequence[Mapping[str, Any]], free: Sequence[str], pictures: Mapping[str, Path]) -> None:
    """Write fits.json, fits.csv and fits.tex, and the picture of each map."""
    table = fit_table(items)
    texts = {
        "fits.json": json.dumps(list(items), indent=1) + "\n",
        "fits.csv": csv_text(table.stored),
        "fits.tex": latex(table.texts, table.caption, table.id),
    }
    for name, text in texts.items():
        write_file(folder / name, text)
    for path, of_map in _maps(folder, items, pictures).items():
        if (figure := draw_map(of_map, free)) is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
            save(figure, path)


def _maps(
    folder: Path, items: Sequence[Mapping[str, Any]], pictures: Mapping[str, Path]
) -> dict[Path, list[Mapping[str, Any]]]:
    """Return the curves of each file of several, and those of the files of one with a position, by the picture."""
    counts = Counter(item["file"] for item in items)
    alone = [item for item in items if counts[item["file"]] == 1 and any(_known(item["position"]))]
    maps = {
        Path(f"{picture}-map.png"): [item for item in items if item["file"] == file]
        for file, picture in pictures.items()
        if counts[file] > 1
    }
    return {folder / "fits-map.png": alone} | maps


def _known(position: Mapping[str, Any]) -> list[bool]:
    return [number is not None for number in position.values()]
