"""Commands that write of finished runs: a page, a board of submissions, and how to cite them."""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.cli.options import JOBS, QUIET, command, file, output_format
from comparisons.cli.screen import output
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.printable import printable
from comparisons.console.progress import log
from comparisons.data.file_names import KAPPA, RECORD, REPORT, RUN_FILES, STORE
from comparisons.output.citation import as_bibtex, as_text, methods, works
from comparisons.output.report.board_page import standings
from comparisons.output.report.page import make_page
from comparisons.output.report.render import rows_path, write_page
from comparisons.output.report.stored_run import read_folder
from comparisons.output.table import laid_out
from comparisons.output.terminal import rich_table
from comparisons.pipeline.board import INDEX, make_board
from comparisons.runs.atomic_files import writable_file
from comparisons.runs.csv_format import read_table
from comparisons.runs.environment import version_text
from comparisons.runs.record import check_files, read_record

_CITED = "folder of a finished run, sweep or comparison, to cite the versions and models that it used"


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


@command(
    file("folder", metavar="DIR", nargs="?", help=_CITED),
    output_format("bibtex", help="text has a paragraph for the Methods section and the references (default: text)"),
)
def cite_command(args: argparse.Namespace) -> int:
    """Print how to cite fscm-bench and what a run used; return the exit status.

    For example::

        fscm-bench cite
        fscm-bench cite --format bibtex results/runs/TIME
    """
    record, paragraph = None, ""
    if args.folder is not None:
        record = read_record(args.folder / RECORD)
        check_files(record, args.folder)
        paragraph = methods(record, _references(args.folder / f"{KAPPA}.csv"))
    cited = works("" if record else version_text(), record)
    print(printable(as_bibtex(cited) if args.format == "bibtex" else as_text(cited, paragraph)), end="")
    return OK


def _references(table: Path) -> dict[str, float]:
    """Return the models that were references, each with its largest relative bound; empty without errors."""
    if not table.is_file():
        return {}
    rows = read_table(table)
    relative = rows["u_reference"] / rows["reference_value"].abs()
    return {str(name): float(bounds.max()) for name, bounds in relative.groupby(rows["reference"])}
