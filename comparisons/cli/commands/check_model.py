"""``fscm-bench check-model``: checks that an external model keeps the contract.

For example::

    fscm-bench check-model my_model.py:MyModel
"""

from __future__ import annotations

import argparse

from comparisons.cli.options import MODEL_SPEC, option
from comparisons.cli.screen import print_lines
from comparisons.console.exit_status import FAILED, FAILS, OK
from comparisons.console.progress import waiting
from comparisons.external.contract_checks import SKIPPED, examine
from comparisons.registry import MODELS, external_model

OPTIONS = (option("spec", metavar="SPEC", help=MODEL_SPEC),)

#: Columns of the status, the longest of which is "not checked".
_STATUS = len(SKIPPED)


def call(args: argparse.Namespace) -> int:
    """Examine and print; return 4 if a computation failed, 1 if something is wrong, else 0."""
    if args.spec in MODELS:
        raise ValueError(f"{args.spec} is a model of fscm-bench; its tests are in tests/comparisons/models")
    model = external_model(args.spec)
    with waiting(f"checking {model.name}"):
        findings = examine(model)
    print_lines(f"{finding.status:{_STATUS}}  {finding.check}: {finding.text}" for finding in findings)
    statuses = {finding.status for finding in findings}
    return FAILED if "failed" in statuses else FAILS if "wrong" in statuses else OK
