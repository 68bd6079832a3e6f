"""Replies of the process of a model: descriptions, results and curves, each with one sentence for an error.

The worker turns what a model returns into these; the parent reads all of them again, since a model can write to the
pipe in place of the worker.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from comparisons.domain import Domain
from comparisons.external.fingerprint import fingerprint
from comparisons.external.reply_checks import column, count, kind, real
from comparisons.external.text_rules import TEXTS, model_name, one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result

__all__ = ["Description", "curve_of", "described", "parsed", "result_of"]

#: What a model states of itself.
_STATED = {*TEXTS, "limits", "applies_to", "files", "curve"}
#: What the worker finds out of a model in Python.
_OF_WORKER = {"digest", "hashed", "physical"}

#: Status of a reply -> the exception that it means.
_STATUSES = {"ok": Exception, "not-applicable": NotApplicable, "failed": ComputationFailed}

#: Digits of the digest that are kept in the version of a model.
_DIGEST = 12


@dataclass(frozen=True, slots=True)
class Description:
    """A model; its texts are single printable lines, and its version ends in a digest of its files."""

    name: str
    version: str
    citation: str
    domain: str
    limits: tuple[str, ...]
    applies_to: Domain | None
    hashed: str
    physical: bool
    has_curve: bool


def parsed(line: bytes, default: dict[str, Any]) -> dict[str, Any]:
    """Return the JSON object of a line, with a status.

    Parameters
    ----------
    line : bytes
    default : dict
        What it has where the line states nothing else.

    Examples
    --------
    >>> parsed(b"1.7", {})
    Traceback (most recent call last):
    comparisons.model.ComputationFailed: its process wrote '1.7', which is not one JSON object in one line
    """
    try:
        reply = json.loads(line.decode(), parse_constant=_refuse_constant)
    except (ValueError, RecursionError):
        reply = None
    if not isinstance(reply, dict):
        shown = one_line(repr(line[:200].decode(errors="replace").strip()), 80)
        raise ComputationFailed(f"its process wrote {shown}, which is not one JSON object in one line")
    reply = default | reply
    if reply.get("status") not in [*_STATUSES]:
        raise ComputationFailed(
            f"the model gave {kind(reply.get('status'))} as status, which is none of {', '.join(_STATUSES)}"
        )
    return reply


def _refuse_constant(name: str) -> NoReturn:
    raise ComputationFailed(f"its process wrote {name}, which is not a finite number, and which JSON does not have")


def _outcome(reply: dict[str, Any], known: set[str], needed: tuple[str, ...]) -> dict[str, Any]:
    """Return a reply that has a result, with known keys and those that it needs; raise what another status means."""
    if reply["status"] != "ok":
        reason = reply.get("reason", "")
        text = one_line(reason) if isinstance(reason, str) else ""
        raise _STATUSES[reply["status"]](text or "the model gave no reason")
    if unknown := sorted(reply.keys() - known - {"status"}):
        raise ComputationFailed(f"the model gave the unknown key {one_line(repr(unknown[0]), 60)}")
    if missing := [name for name in needed if name not in reply]:
        raise ComputationFailed(f"the reply of the model has no {', '.join(missing)}")
    return reply


def described(reply: dict[str, Any], source: dict[str, Any]) -> Description:
    """Return what the reply to the request ``describe`` states.

    Parameters
    ----------
    reply : dict
    source : dict
        Of the model; the files of a program are hashed here.

    Raises
    ------
    comparisons.model.ComputationFailed
        If it does not describe a model; the sentence has the reason.
    """
    program = source["kind"] == "program"
    reply = _outcome(reply, _STATED if program else _STATED | _OF_WORKER, TEXTS)
    for name in TEXTS:
        if not isinstance(reply[name], str):
            raise ComputationFailed(f"the model gave {kind(reply[name])} as {name}, which is not a text")
    limits = reply.get("limits", [])
    if not isinstance(limits, list) or not all(isinstance(limit, str) for limit in limits):
        raise ComputationFailed(
            f'limits = {kind(limits)} is not a list of texts such as ("jkr",): it names where the model is exact'
        )
    if program:
        file = Path(source["file"])
        digest, hashed = fingerprint({file.parent: file}, reply.get("files", ()), skip=source["skip"])
    else:
        digest, hashed = str(reply.get("digest")), str(reply.get("hashed"))
    domain = reply.get("applies_to")
    try:
        return Description(
            model_name(reply["name"]),
            f"{one_line(reply['version'], 60)} ({one_line(digest)[:_DIGEST]})",
            one_line(reply["citation"]),
            one_line(reply["domain"]),
            tuple(one_line(limit, 60) for limit in limits),
            None if domain is None else Domain.of(domain),
            one_line(hashed),
            bool(reply.get("physical")),
            reply.get("curve") is True,
        )
    except (ValueError, TypeError) as error:
        raise ComputationFailed(one_line(str(error))) from None


def result_of(reply: dict[str, Any]) -> Result:
    """Return the result that a reply has."""
    reply = _outcome(reply, {"value", "u_num", "size", "iterations", "residual"}, ("value", "u_num"))
    return Result(
        real("value", reply["value"]),
        real("u_num", reply["u_num"]),
        size=count("size", reply.get("size", 0)),
        iterations=count("iterations", reply.get("iterations", 0)),
        residual=real("residual", reply.get("residual", 0.0)),
    )


def curve_of(reply: dict[str, Any]) -> Curve:
    """Return the curve that a reply has."""
    reply = _outcome(reply, {"displacement", "load", "columns"}, ("displacement", "load"))
    more = reply.get("columns", {})
    if not isinstance(more, dict):
        raise ComputationFailed(f"the model gave {kind(more)} as columns, which is not a table of columns")
    columns = {name: column(name, reply[name]) for name in ("displacement", "load")}
    columns |= {one_line(name, 60): column(name, values) for name, values in more.items()}
    if len(set(map(len, columns.values()))) != 1:
        listed = ", ".join(f"{name} {len(values)}" for name, values in columns.items())
        raise ComputationFailed(f"the columns of the curve have different lengths: {listed}")
    return Curve(columns.pop("displacement"), columns.pop("load"), columns)
