"""Replies of the process of a model, checked by ``comparisons/data/reply.schema.json``.

The parent checks all of them, since a model in Python can write to the pipe in place of the worker.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from comparisons.data.file_names import SUBMISSION
from comparisons.data.validation import shown, validated
from comparisons.domain import Domain
from comparisons.external.fingerprint import fingerprint
from comparisons.external.text_rules import model_name, one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result

#: Status of a reply without a result -> the exception that it means.
_REFUSALS = {"not-applicable": NotApplicable, "failed": ComputationFailed}

#: Digits of the digest that are kept in the version of a model.
_DIGEST = 12

#: Most brackets of a reply, twenty times those of the longest domain: an empty list needs twenty times the memory of
#: its two bytes.
_MOST_BRACKETS = 2500


class Malformed(ComputationFailed):
    """A line that is no reply: what the process writes next may belong to another request."""


def described(line: bytes, source: dict[str, Any]) -> dict[str, Any]:
    """Return what the reply to the request ``describe`` states, as attributes of `comparisons.external.process_model`.

    Texts are single printable lines, and the version ends in a digest of the files of the model.

    Parameters
    ----------
    line : bytes
    source : dict
        Of the model. The worker of a model in Python adds where its files are.

    Raises
    ------
    comparisons.model.ComputationFailed
        If it does not describe a model; the sentence has the reason.
    """
    reply = {"status": "ok"} | _parsed(line)
    of_worker = {} if source["kind"] == "program" else reply.pop("python", {})
    _check("describe", reply)
    try:
        roots, loaded = _files_of(source, of_worker)
        within = _submission_of(Path(source["file"]).parent) if "file" in source else None
        digest, hashed = fingerprint(roots, reply.get("files", []), loaded, within)
        domain = reply.get("applies_to")
        return {
            "name": model_name(reply["name"]),
            "version": f"{one_line(reply['version'], 60)} ({digest[:_DIGEST]})",
            "citation": one_line(reply["citation"]),
            "domain": one_line(reply["domain"]),
            "hashed": hashed,
            "limits": tuple(one_line(limit, 60) for limit in reply.get("limits", [])),
            "applies_to": None if domain is None else Domain.of(domain),
            "has_curve": reply.get("curve", False),
        }
    except (ValueError, OSError) as error:
        raise ComputationFailed(one_line(str(error))) from None


def _files_of(source: dict[str, Any], stated: dict[str, Any]) -> tuple[dict[Path, Path], list[Path]]:
    """Return the folders of a model with the file that was loaded in each, and other files that were.

    A model in Python can state any in place of the worker: they are where they are said to be, and the folder of the
    file that was asked for is one of them.
    """
    if stated:
        validated({"python": stated}, "reply", "the reply of the model")
    roots = {Path(root): Path(file) for root, file in stated.get("roots", {}).items()}
    for root, file in roots.items():
        if not (root.is_absolute() and os.path.isdir(root) and file.is_relative_to(root) and os.path.isfile(file)):
            raise ValueError(f"its process states that {shown(str(file))} was loaded from {shown(str(root))}")
    if "file" in source:
        file = Path(source["file"])
        roots |= {file.parent: file}
    return roots, [Path(path) for path in stated.get("loaded", [])]


def _submission_of(folder: Path) -> Path | None:
    """Return the folder of the submission that a folder is in."""
    return next((parent for parent in (folder, *folder.parents) if (parent / SUBMISSION).is_file()), None)


def result_of(line: bytes) -> Result:
    """Return the result that a reply has, or raise what its status means.

    Examples
    --------
    >>> result_of(b'{"status": "ok", "value": 1.5, "unum": 0}')
    Traceback (most recent call last):
    comparisons.external.replies.Malformed: the reply of the model: evaluate: unknown key 'unum': did you mean u_num?
    """
    reply = _parsed(line)
    _check("evaluate", reply)
    return Result(
        float(reply["value"]),
        float(reply["u_num"]),
        size=int(reply.get("size", 0)),
        iterations=int(reply.get("iterations", 0)),
        residual=float(reply.get("residual", 0.0)),
    )


def curve_of(line: bytes) -> Curve:
    """Return the curve that a reply has, or raise what its status means."""
    reply = _parsed(line)
    _check("curve", reply)
    stated = {name: reply[name] for name in ("displacement", "load")} | reply.get("columns", {})
    columns = {one_line(name, 60): _column(name, values) for name, values in stated.items()}
    if len(set(map(len, columns.values()))) != 1:
        listed = ", ".join(f"{name} {len(values)}" for name, values in columns.items())
        raise Malformed(f"the columns of the curve have different lengths: {listed}")
    return Curve(columns.pop("displacement"), columns.pop("load"), columns)


def _parsed(line: bytes) -> dict[str, Any]:
    if line.count(b"[") + line.count(b"{") > _MOST_BRACKETS:
        raise Malformed(f"its process wrote a line with more than {_MOST_BRACKETS} brackets, which no reply has")
    try:
        reply = json.loads(line.decode(), parse_constant=_refuse_constant)
    except (ValueError, RecursionError):
        reply = None
    if not isinstance(reply, dict):
        quoted = one_line(repr(line[:200].decode(errors="replace").strip()), 80)
        raise Malformed(f"its process wrote {quoted}, which is not one JSON object in one line")
    return reply


def _refuse_constant(name: str) -> NoReturn:
    raise Malformed(f"its process wrote {name}, which is not a finite number, and which JSON does not have")


def _check(request: str, reply: dict[str, Any]) -> None:
    """Raise what the status of a reply means, or the first thing that is wrong in its other keys, which stay."""
    status = reply.pop("status", None)
    if isinstance(status, str) and status in _REFUSALS:
        reason = reply.get("reason", "")
        raise _REFUSALS[status](one_line(str(reason)) or "the model gave no reason")
    if status != "ok":
        raise Malformed(
            f"the reply of the model: status = {one_line(repr(status), 60)} must be ok, {' or '.join(_REFUSALS)}"
        )
    try:
        validated({request: reply}, "reply", "the reply of the model")
    except ValueError as error:
        raise Malformed(one_line(str(error))) from None


def _column(name: str, values: list[Any]) -> NDArray[np.float64]:
    try:
        column = np.asarray(values)
    except ValueError:  # lists of different lengths
        column = np.empty((0, 0))
    if column.ndim != 1 or column.dtype.kind not in "fiu" or not np.isfinite(column).all():
        raise Malformed(f"column {one_line(name, 60)} of the curve is not a list of finite real numbers")
    return column.astype(float)
