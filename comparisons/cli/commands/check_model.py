"""``fscm-bench check-model``: checks that an external model keeps the contract."""

from __future__ import annotations

import argparse

from comparisons.cli.options import FAILED, FAILS, OK, output
from comparisons.cli.verdict_screen import print_lines
from comparisons.console.folding import folded
from comparisons.console.progress import waiting
from comparisons.external.contract_checks import examine
from comparisons.external.evaluations import SKIPPED, Finding
from comparisons.external.model_source import load_model
from comparisons.registry import MODELS

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench check-model my_model.py:MyModel",)

#: Columns of the status, the longest of which is "not checked".
_STATUS = len(SKIPPED)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument(
        "spec",
        metavar="SPEC",
        help="name of an installed model, FILE.py:CLASS, ./PROGRAM, or a folder with a model.toml",
    )


def call(args: argparse.Namespace) -> int:
    """Examine and print; return 4 if a computation failed, 1 if something is wrong, else 0."""
    if args.spec in MODELS:
        raise ValueError(f"{args.spec} is a model of fscm-bench; its tests are in tests/comparisons/models")
    model = load_model(args.spec)
    if model.name in MODELS:
        raise ValueError(f"the name {model.name} belongs to a model of fscm-bench: choose another name")
    with waiting(f"checking {model.name}"):
        findings = examine(model)
    print_lines(line for finding in findings for line in _lines(finding, output().width))
    found = {finding.status for finding in findings}
    if "failed" in found:
        return FAILED
    return FAILS if "wrong" in found else OK


def _lines(finding: Finding, width: int) -> list[str]:
    lead = f"{finding.status:{_STATUS}}  "
    first, *others = folded(f"{finding.check}: {finding.text}", width - len(lead))
    return [lead + first, *(" " * len(lead) + line for line in others)]
