"""Commands on what there is, and on models of one's own: lists, a template, and checks of the contract."""

from __future__ import annotations

import argparse
from shlex import quote
from typing import TYPE_CHECKING

import lazy_loader

from comparisons.cli.options import MODEL_SPEC, command, file, option
from comparisons.cli.screen import print_text
from comparisons.console.exit_status import FAILED, FAILS, OK
from comparisons.console.progress import log, waiting
from comparisons.external.contract_checks import SKIPPED, examine
from comparisons.external.template import write_template
from comparisons.registry import MODELS, external_model
from comparisons.runs.atomic_files import writing

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")

#: Columns of the status, the longest of which is "not checked".
_STATUS = len(SKIPPED)


@command(file("folder", metavar="DIR", help="new folder, e.g. my-model; its name becomes that of the model"))
def new_model_command(args: argparse.Namespace) -> int:
    """Write a new package with a working model, a test and a CI workflow; return the exit status.

    For example::

        fscm-bench new-model my-model
    """
    with writing(args.folder, "folder", "choose another one"):
        written, spec = write_template(args.folder, reserved=MODELS)
    for path in written:
        print(path)
    log(f"change what the model computes; then: fscm-bench check-model {quote(spec)}")
    return OK


@command(option("spec", metavar="SPEC", help=MODEL_SPEC))
def check_model_command(args: argparse.Namespace) -> int:
    """Examine and print; return 4 if a computation failed, 1 if something is wrong, else 0.

    For example::

        fscm-bench check-model my_model.py:MyModel
    """
    if args.spec in MODELS:
        raise ValueError(f"{args.spec} is a model of fscm-bench; its tests are in tests/comparisons/models")
    model = external_model(args.spec)
    with waiting(f"checking {model.name}"):
        findings = examine(model)
    print_text(f"{finding.status:{_STATUS}}  {finding.check}: {finding.text}" for finding in findings)
    statuses = {finding.status for finding in findings}
    return FAILED if "failed" in statuses else FAILS if "wrong" in statuses else OK
