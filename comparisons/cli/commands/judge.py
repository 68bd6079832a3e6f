"""``fscm-bench judge``: a new judgement of the stored results of a run, by its own gates or others.

For example::

    fscm-bench judge results/mine --verbose
"""

from __future__ import annotations

import argparse
from shlex import quote

from comparisons.cli.options import QUIET, VERBOSE, file
from comparisons.cli.verdict_screen import STATUS, print_verdicts
from comparisons.console.progress import note
from comparisons.pipeline.judgement import judge_folder

OPTIONS = (
    file("folder", metavar="DIR", help="folder of a finished run"),
    file("--gates", help="judge by these gates instead of those of the run"),
    VERBOSE,
    QUIET,
)


def call(args: argparse.Namespace) -> int:
    """Judge and print; return the exit status."""
    judgement = judge_folder(args.folder, args.gates)
    print_verdicts(judgement, verbose=args.verbose, quiet=args.quiet)
    if not judgement.verdicts.empty:
        note(f"next: fscm-bench report {quote(str(args.folder))}")
    return STATUS[judgement.verdict]
