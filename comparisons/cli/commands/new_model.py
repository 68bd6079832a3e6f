"""``fscm-bench new-model``: a new package with a working model, a test and a CI workflow."""

from __future__ import annotations

import argparse
from pathlib import Path
from shlex import quote

from comparisons.cli.options import OK
from comparisons.console.progress import log
from comparisons.external.template import write_template
from comparisons.registry import MODELS

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench new-model my-model",)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("folder", metavar="DIR", type=Path, help="new folder; the model gets its name, e.g. my-model")


def call(args: argparse.Namespace) -> int:
    """Write the files and name them; return the exit status."""
    written, spec = write_template(args.folder, reserved=MODELS)
    for path in written:
        print(path)
    log(f"change what the model computes; then: fscm-bench check-model {quote(spec)}")
    return OK
