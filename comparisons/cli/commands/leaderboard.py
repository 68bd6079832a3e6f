"""``fscm-bench leaderboard``: any number of runs as one sortable HTML table that needs no other file.

For example::

    fscm-bench leaderboard results/mine results/other --out leaderboard.html
"""

from __future__ import annotations

import argparse

from comparisons.cli.options import file, option
from comparisons.cli.screen import write_page
from comparisons.console.exit_status import OK
from comparisons.pipeline.board import leaderboard
from comparisons.runs.atomic_files import writable_file

OPTIONS = (
    file("folders", metavar="DIR", nargs="+", help="folders of finished runs or sweeps"),
    file("--out", metavar="FILE.html", required=True, help="the page to write"),
    option("--mixed", action="store_true", help="accept runs with different cases or gates; the page says so"),
)


def call(args: argparse.Namespace) -> int:
    """Read, lay out and write; return the exit status."""
    path = writable_file(args.out)
    if path.suffix.lower() not in (".html", ".htm"):
        raise ValueError(f"--out {path} must end in .html: the leaderboard is a page for a browser")
    write_page(leaderboard(args.folders, args.mixed), path, "leaderboard")
    return OK
