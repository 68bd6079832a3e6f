"""``fscm-bench merge``: the shards of a sweep in one folder, with the tables of the whole sweep."""

from __future__ import annotations

import argparse
from contextlib import nullcontext
from pathlib import Path

from comparisons.cli.commands.sweep import show
from comparisons.cli.options import FAILED, add_quiet
from comparisons.console.progress import log, quiet
from comparisons.model import ComputationFailed
from comparisons.pipeline.merge import merge

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench merge results/shard1 results/shard2 --out results/sweep",)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("folders", metavar="DIR", nargs="+", type=Path, help="folders of fscm-bench sweep --shard")
    parser.add_argument("--out", metavar="DIR", type=Path, required=True, help="folder for the whole sweep")
    add_quiet(parser)


def call(args: argparse.Namespace) -> int:
    """Merge, write and print; return the exit status."""
    with quiet() if args.quiet else nullcontext():
        try:
            finished = merge(args.folders, args.out)
        except ComputationFailed as failure:
            log(str(failure))
            return FAILED
        return show(finished, with_summary=not args.quiet)
