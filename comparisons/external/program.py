"""A program that speaks JSON lines on stdin and stdout, as a model; it runs below the child process of the model.

The program inherits the limits of that process and its right to write in the scratch folder alone.  One request is one
line, and so is its reply; docs/judge_your_model.md has the protocol.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from comparisons.external.program_process import TEXTS, ProgramProcess, outcome, require
from comparisons.external.reply_checks import column, count, kind, real
from comparisons.model import ComputationFailed, Curve, Result
from fscm.problem import Problem

__all__ = ["ProgramModel", "program_model"]

_EVALUATED = {"status", "value", "u_num", "size", "iterations", "residual"}
_DRAWN = {"status", "displacement", "load", "columns"}


class ProgramModel:
    """A model whose equations are in a program.

    Parameters
    ----------
    file : Path
        Of the program.
    described : dict
        Its reply to ``{"request": "describe"}``.
    process : ProgramProcess
        The program, running.
    """

    def __init__(self, file: Path, described: dict[str, Any], process: ProgramProcess) -> None:
        self._file = file
        self._described = described
        self._process: ProgramProcess | None = process
        self.name, self.version, self.citation, self.domain = (described[name] for name in TEXTS)
        self.limits = described.get("limits", [])
        self.files = described.get("files", [])
        self.applies_to = described.get("applies_to")

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise `NotApplicable` or `ComputationFailed`."""
        reply = self._reply({"request": "evaluate", "quantity": quantity, **_parameters(problem)}, _EVALUATED)
        require(reply, ("value", "u_num"))
        return Result(
            real("value", reply["value"]),
            real("u_num", reply["u_num"]),
            size=count("size", reply.get("size", 0)),
            iterations=count("iterations", reply.get("iterations", 0)),
            residual=real("residual", reply.get("residual", 0.0)),
        )

    def _reply(self, request: dict[str, Any], known: set[str]) -> dict[str, Any]:
        try:
            if self._process is None or self._process.has_ended():
                self._process = self._again()
            reply = self._process.exchange(request)
        except ComputationFailed:
            if self._process is not None:
                self._process.end()
            self._process = None
            raise
        return outcome(reply, known)

    def _again(self) -> ProgramProcess:
        again, described = _started(self._file)
        if described != self._described:
            again.end()
            raise ComputationFailed("the program describes itself in another way after it was started again")
        return again


class ProgramModelWithCurve(ProgramModel):
    """A model whose equations are in a program that has a force-displacement curve as well."""

    def curve(self, problem: Problem) -> Curve:
        """Return the curve, or raise as `evaluate`."""
        reply = self._reply({"request": "curve", **_parameters(problem)}, _DRAWN)
        require(reply, ("displacement", "load"))
        more = reply.get("columns", {})
        if not isinstance(more, dict):
            raise ComputationFailed(f"the program gave {kind(more)} as columns, which is not a JSON object of lists")
        columns = {name: np.asarray(column(name, values)) for name, values in more.items()}
        return Curve(
            np.asarray(column("displacement", reply["displacement"])),
            np.asarray(column("load", reply["load"])),
            columns,
        )


def program_model(file: Path) -> ProgramModel:
    """Start a program and return the model that it describes.

    Raises
    ------
    comparisons.model.ComputationFailed
        If it cannot be started, or does not describe a model.
    """
    process, described = _started(file)
    cls = ProgramModelWithCurve if described.get("curve") is True else ProgramModel
    return cls(file, described, process)


def _started(file: Path) -> tuple[ProgramProcess, dict[str, Any]]:
    process = ProgramProcess(file)
    try:
        return process, process.described()
    except BaseException:
        process.end()
        raise


def _parameters(problem: Problem) -> dict[str, float]:
    return {"n": problem.n, "k": problem.k, "mu": problem.mu}
