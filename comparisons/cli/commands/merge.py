"""``fscm-bench merge``: the shards of a sweep in one folder, with the tables of the whole sweep.

For example::

    fscm-bench merge results/shard1 results/shard2 --out results/sweep
"""

from __future__ import annotations

import argparse

from comparisons.cli.commands.sweep import show
from comparisons.cli.options import QUIET, file
from comparisons.pipeline.merge import merge

OPTIONS = (
    file("folders", metavar="DIR", nargs="+", help="folders written by fscm-bench sweep --shard"),
    file("--out", metavar="DIR", required=True, help="folder for the whole sweep"),
    QUIET,
)


def call(args: argparse.Namespace) -> int:
    """Merge, write and print; return the exit status."""
    return show(merge(args.folders, args.out), with_summary=not args.quiet)
