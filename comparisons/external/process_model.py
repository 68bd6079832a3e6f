"""An external model in a process of its own, as a `comparisons.model.Model`."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeVar

from comparisons.domain import Domain
from comparisons.external.child import Child, Overdue, TimeIsOver
from comparisons.external.inherited import hidden_folders, is_inside
from comparisons.external.replies import Malformed, curve_of, described, result_of
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES

_Reply = TypeVar("_Reply", Result, Curve)

#: Requests in a row that may run out of time or disk; later ones are not sent, because a run of hundreds must end.
PATIENCE = 3


class ExternalModel:
    """A model in a process of its own, which is started again after it had to be ended.

    Attributes
    ----------
    name, version, citation, domain : str
        As in `comparisons.model.Model`; `version` ends in a digest of the model's files.
    hashed : str
        Which files these are, in words.
    limits : tuple of str
        Limits in which the model is exact, as its author states (see `comparisons.external.contract_checks`).
    applies_to : Domain or None
        The domain that it declares.
    is_program : bool
        Whether it is a program, and no class of Python.
    """

    name: str
    version: str
    citation: str
    domain: str
    hashed: str
    limits: tuple[str, ...]
    applies_to: Domain | None

    def __init__(self, source: dict[str, Any]) -> None:
        self._source = source
        self._child, stated = _started(source)
        if stated.pop("has_curve"):
            self.curve = self._curve
        vars(self).update(stated)
        self._refusal, self._overdue = "", 0
        self.is_program = source["kind"] == "program"

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise `NotApplicable` or `ComputationFailed`; nothing else."""
        if quantity not in QUANTITIES:
            raise ValueError(f"quantity {quantity!r} is unknown; the known ones are {', '.join(QUANTITIES)}")
        started = time.perf_counter()
        result = self._reply({"request": "evaluate", "quantity": quantity}, problem, result_of)
        return replace(result, seconds=time.perf_counter() - started)

    def _curve(self, problem: Problem) -> Curve:
        """Return the curve of a model that has one, or raise as `evaluate`."""
        return self._reply({"request": "curve"}, problem, curve_of)

    def close(self) -> None:
        """End the process; the next request starts a new one."""
        self._child.close()

    def _reply(self, request: dict[str, Any], problem: Problem, read: Callable[[bytes], _Reply]) -> _Reply:
        if self._refusal:
            raise ComputationFailed(self._refusal)
        try:
            if self._child.has_ended():
                self._start_again()
            reply = self._child.exchange({**request, "n": problem.n, "k": problem.k, "mu": problem.mu})
        except Overdue:
            self._overdue += 1
            if self._overdue >= PATIENCE:
                self._refusal = f"not evaluated: it ran out of time or disk {PATIENCE} times in a row"
            raise
        except TimeIsOver as error:
            self._refusal = f"not evaluated: {error}"
            raise
        # Only the reply to a case shows that the model can be in time; loading it again does not.
        self._overdue = 0
        try:
            return read(reply)
        except Malformed:
            self.close()
            raise

    def _start_again(self) -> None:
        self.close()
        self._child, again = _started(self._source)
        before, now = (self.name, self.version), (again["name"], again["version"])
        if now != before:
            self.close()
            self._refusal = contradiction(before, now)
            raise ComputationFailed(self._refusal)


def connect(source: dict[str, Any], spec: str) -> ExternalModel:
    """Start a process that loads the model, and return the model.

    Raises
    ------
    ValueError
        If the model cannot be loaded, its name or texts are not admissible, or its file is hidden from it.
    """
    _check_hidden(source)
    if os.name != "posix":
        raise ValueError("models that are code are run on Linux and macOS only; predictions as data everywhere")
    try:
        return ExternalModel(source)
    except (ComputationFailed, NotApplicable) as failure:
        raise ValueError(f"the model {one_line(spec, 200)} cannot be loaded: {one_line(str(failure))}") from None


def _check_hidden(source: dict[str, Any]) -> None:
    """Refuse a model whose process could not read its own file, or Python."""
    for folder in hidden_folders():
        for path in filter(None, (source.get("file"), sys.prefix, sys.base_prefix)):
            if is_inside(os.path.realpath(path), folder):
                raise ValueError(
                    f"{one_line(path, 200)} is in the folder of the results {one_line(folder, 200)}, which the process "
                    "of a model cannot read; choose another --out"
                )


def contradiction(before: tuple[str, str], now: tuple[str, str]) -> str:
    """Return the sentence for a model whose name, version or files are not the same in a later process.

    Parameters
    ----------
    before, now : tuple of str
        Its name and version; the version ends in a digest of its files.

    Examples
    --------
    >>> contradiction(("mine", "1 (ab)"), ("mine", "1 (cd)"))
    "the model's name, version or files changed after it was loaded: it is mine 1 (cd) in a later process, and ..."
    """
    later = f"it is {' '.join(now)} in a later process, and was {' '.join(before)}"
    return one_line(f"the model's name, version or files changed after it was loaded: {later}")


def _started(source: dict[str, Any]) -> tuple[Child, dict[str, Any]]:
    child = Child(source)
    try:
        return child, described(child.exchange({"request": "describe"}), source)
    except BaseException:
        child.close()
        raise
