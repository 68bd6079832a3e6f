"""``fscm-bench check-model``: checks that an external model keeps the contract."""

from __future__ import annotations

import argparse

from comparisons.cli.options import FAILED, FAILS, OK
from comparisons.console.progress import waiting
from comparisons.external.contract_checks import examine
from comparisons.external.model_source import load_model
from comparisons.registry import MODELS

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench check-model my_model.py:MyModel",)


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
    width = max(len(finding.status) for finding in findings)
    for finding in findings:
        print(f"{finding.status:{width}}  {finding.check}: {finding.text}")
    found = {finding.status for finding in findings}
    if "failed" in found:
        return FAILED
    return FAILS if "wrong" in found else OK
