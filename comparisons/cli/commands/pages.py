"""Commands that write of finished runs: a page, the supplement of a paper, and a board of submissions."""

from __future__ import annotations

import argparse

from comparisons.cli.options import JOBS, QUIET, command, file
from comparisons.cli.screen import output
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log
from comparisons.data.file_names import RECORD, REPORT, RUN_FILES, STORE
from comparisons.output.report.board_page import standings
from comparisons.output.report.page import make_page
from comparisons.output.report.render import rows_path, write_page
from comparisons.output.report.stored_run import read_folder
from comparisons.output.supplement.document import DOCUMENT
from comparisons.output.supplement.write import write_supplement
from comparisons.output.table import laid_out
from comparisons.output.terminal import rich_table
from comparisons.pipeline.board import INDEX, make_board
from comparisons.runs.atomic_files import writable_file


@command(
    file("folder", metavar="DIR", help="folder of a finished run"),
    file("--out", help="the page to write (default: DIR/report.html)"),
)
def report_command(args: argparse.Namespace) -> int:
    """Read, lay out and write; return the exit status.

    For example::

        fscm-bench report results/mine --out report.html
    """
    if (args.folder / "fits.json").is_file():
        raise ValueError(f"{args.folder} has fits, which have no page: fits.csv, fits.tex and the pictures are in it")
    stored = read_folder(args.folder)
    page, path = make_page(stored), writable_file(args.out or args.folder / REPORT)
    for name in (RECORD, STORE, *RUN_FILES, *stored.record["files"]):
        if (args.folder / name).resolve() in (path.resolve(), rows_path(path).resolve()):
            raise ValueError(f"--out {path} is a file of the run, which the page would replace; choose another file")
    write_page(page, path)
    log(f"the report is {path}")
    return OK


@command(
    file("folder", metavar="DIR", help="folder of a finished run, sweep or comparison"),
    file("--out", metavar="FOLDER", help="folder to write (default: DIR/supplement)"),
)
def supplement_command(args: argparse.Namespace) -> int:
    """Read and write; return the exit status.

    For example::

        fscm-bench supplement results/mine --out paper/supplement
    """
    out = args.out or args.folder / "supplement"
    if out.resolve() == args.folder.resolve():
        raise ValueError(f"--out {out} is the folder of the run; choose a new one")
    write_supplement(read_folder(args.folder), args.folder, out)
    log(f"the supplement is {out / DOCUMENT}")
    return OK


@command(
    file("submissions", metavar="SUBMISSIONS", help="a folder of submissions, or one submission; see docs/board.md"),
    file("--out", metavar="SITE", required=True, help="folder for the site; unchanged results in it are kept"),
    JOBS,
    QUIET,
)
def board_command(args: argparse.Namespace) -> int:
    """Judge, write and print; return the exit status, 4 if a submission could not be judged.

    For example::

        fscm-bench board docs/board/submissions --out site
    """
    entries = make_board(args.submissions, args.out, args.jobs)
    rows = standings(entries)
    if len(rows) and not args.quiet:
        board = laid_out("board_on_screen", rows)
        output().print(rich_table(board.texts, board.caption))
    log(f"the board is {args.out / INDEX}")
    return OK if all(entry.judged for entry in entries) else FAILED
