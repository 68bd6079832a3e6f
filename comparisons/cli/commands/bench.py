"""``fscm-bench bench``: time, memory and error of the accurate solver beside the paper's own scheme."""

from __future__ import annotations

import argparse

from comparisons.cli.options import FAILED, OK, output
from comparisons.console.progress import log, waiting
from comparisons.output.scheme_benchmark import compare, measure
from comparisons.output.tables import rich_table
from comparisons.runs.cases import Case
from comparisons.runs.tasks import Task

__all__ = ["add", "call"]

ACCURATE, BASELINE = "fscm", "fscm-stieltjes"
QUANTITY, CASE = "pull_off_force", Case(n=2, k=0.4, mu=1)
_FORMATS = {ACCURATE: ".9g", BASELINE: ".9g", "ratio": ".0f"}


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments: there are none."""


def call(args: argparse.Namespace) -> int:
    """Measure and print; return the exit status.  The time of each model includes its own error estimate."""
    measured = []
    for model in (ACCURATE, BASELINE):
        with waiting(f"{model}: {QUANTITY} at {CASE.label}"):
            measured.append(measure(Task(model, QUANTITY, CASE)))
    failed = [one.row for one in measured if one.row.status != "ok"]
    for row in failed:
        log(f"{row.model}: {row.status}: {row.reason}")
    if failed:
        return FAILED
    output().print(rich_table(compare(*measured), f"{QUANTITY} at {CASE.label}, one thread", _FORMATS))
    return OK
