"""``fscm-bench board``: a static site of submitted models with their errors, verdicts and history.

For example::

    fscm-bench board docs/board/submissions --out site
"""

from __future__ import annotations

import argparse

from comparisons.cli.options import JOBS, QUIET, file
from comparisons.cli.screen import output
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log
from comparisons.output.report.board import standings
from comparisons.output.table import laid_out
from comparisons.output.terminal import rich_table
from comparisons.pipeline.board import INDEX, make_board

OPTIONS = (
    file("submissions", metavar="SUBMISSIONS", help="a folder of submissions, or one submission; see docs/board.md"),
    file("--out", metavar="SITE", required=True, help="folder for the site; unchanged results in it are kept"),
    JOBS,
    QUIET,
)


def call(args: argparse.Namespace) -> int:
    """Judge, write and print; return the exit status, 4 if a submission could not be judged."""
    entries = make_board(args.submissions, args.out, args.jobs)
    rows = standings(entries)
    if len(rows) and not args.quiet:
        board = laid_out("board_on_screen", rows)
        output().print(rich_table(board.texts, board.caption))
    log(f"the board is {args.out / INDEX}")
    return OK if all(entry.judged for entry in entries) else FAILED
