"""``fscm-bench paper``: every figure of the paper, computed again, with its data.

For example::

    fscm-bench paper --figure 16 --out results/paper
"""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.cli.options import JOBS, file, several
from comparisons.cli.screen import output
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log
from comparisons.paper.registry import NAMES
from comparisons.pipeline.figures import make_figures

OPTIONS = (
    several("--figure", "--only", metavar="N", help=f"only these of {', '.join(NAMES)} (default: all)"),
    JOBS,
    file(
        "--out",
        metavar="DIR",
        default=Path("results", "runs", "paper"),
        help="folder for the files (default: %(default)s); resumed if it has some results",
    ),
)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write the figures, print their files; return the exit status."""
    finished = make_figures(args.figure, args.out, jobs=args.jobs)
    console = output()
    for written in finished:
        figure = written.figure
        if written.failure:
            log(f"{figure.stem}: {written.failure}")
            continue
        console.print(f"{figure.stem}: {figure.title} ({len(written.files)} files)")
        if printed := figure.printed(written.tables):
            console.print(printed)
    console.print(f"written to {args.out}")
    return FAILED if any(written.failure for written in finished) else OK
