"""``fscm-bench new-model``: a new package with a working model, a test and a CI workflow.

For example::

    fscm-bench new-model my-model
"""

from __future__ import annotations

import argparse
from shlex import quote

from comparisons.cli.options import file
from comparisons.console.exit_status import OK
from comparisons.console.progress import log
from comparisons.external.template import write_template
from comparisons.registry import MODELS
from comparisons.runs.atomic_files import writing

OPTIONS = (file("folder", metavar="DIR", help="new folder, e.g. my-model; its name becomes that of the model"),)


def call(args: argparse.Namespace) -> int:
    """Write the files and name them; return the exit status."""
    with writing(args.folder, "folder", "choose another one"):
        written, spec = write_template(args.folder, reserved=MODELS)
    for path in written:
        print(path)
    log(f"change what the model computes; then: fscm-bench check-model {quote(spec)}")
    return OK
