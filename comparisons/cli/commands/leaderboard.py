"""``fscm-bench leaderboard``: any number of runs as one sortable HTML table that needs no other file."""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.cli.options import OK
from comparisons.console.progress import log
from comparisons.pipeline.leaderboard import leaderboard
from comparisons.runs.atomic_files import atomic, writable_file

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench leaderboard results/mine results/other --out leaderboard.html",)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("folders", metavar="DIR", type=Path, nargs="+", help="folders of finished runs or sweeps")
    parser.add_argument("--out", metavar="FILE.html", type=Path, required=True, help="the page")
    parser.add_argument(
        "--mixed", action="store_true", help="accept runs of different cases or gates; the page states it"
    )


def call(args: argparse.Namespace) -> int:
    """Read, lay out and write; return the exit status."""
    path = writable_file(args.out)
    if path.suffix.lower() not in (".html", ".htm"):
        raise ValueError(f"--out {path} must end in .html: the leaderboard is a page for a browser")
    text = leaderboard(args.folders, args.mixed)
    with atomic(path) as file:
        file.write(text.encode())
    log(f"the leaderboard is {path}")
    return OK
