"""``fscm-bench paper``: every figure of the paper, computed again, with its data."""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path

from comparisons.cli.options import FAILED, OK, add_jobs, add_retry_failed, output
from comparisons.console.progress import log
from comparisons.model import ComputationFailed
from comparisons.paper.registry import NAMES
from comparisons.pipeline.figures import make_figures

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench paper --figure 16 --out results/paper",)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument(
        "--figure",
        "--only",
        metavar="N",
        nargs="+",
        action="extend",
        help=f"only these of {', '.join(NAMES)} (default: all)",
    )
    add_jobs(parser)
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        default=Path("results", "runs", "paper"),
        help="folder for the files (default: %(default)s); resumed if it has some results",
    )
    add_retry_failed(parser)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write the figures, print their files; return the exit status."""
    try:
        finished = make_figures(args.figure, args.out, jobs=args.jobs, retry_failed=args.retry_failed)
    except ComputationFailed as failure:
        log(str(failure))
        return FAILED
    console = output()
    for one in finished.figures:
        figure = one.figure
        if one.failure:
            log(f"{figure.stem}: {one.failure}")
            continue
        kinds = Counter(path.suffix[1:] for path in one.files)
        console.print(
            f"{figure.stem}: {figure.title} ({', '.join(f'{count} {kind}' for kind, count in kinds.items())})"
        )
        if figure.shown:
            console.print(figure.shown(one.tables))
    console.print(f"written to {finished.folder}")
    return FAILED if finished.failures else OK
