"""``fscm-bench report``: the folder of a run as one HTML page that needs no other file.

For example::

    fscm-bench report results/mine --out report.html
"""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.cli.options import file
from comparisons.cli.screen import write_page
from comparisons.console.exit_status import OK
from comparisons.data.file_names import RECORD, REPORT, RUN_FILES, STORE
from comparisons.output.report.page import make_page
from comparisons.output.report.render import render
from comparisons.output.report.stored_run import read_folder
from comparisons.runs.atomic_files import writable_file
from comparisons.runs.record import read_record

OPTIONS = (
    file("folder", metavar="DIR", help="folder of a finished run"),
    file("--out", help="the page to write (default: DIR/report.html)"),
)


def call(args: argparse.Namespace) -> int:
    """Read, lay out and write; return the exit status."""
    if (args.folder / "fits.json").is_file():
        raise ValueError(f"{args.folder} has fits, which have no page: fits.csv, fits.tex and the pictures are in it")
    page = make_page(read_folder(args.folder))
    path = _page_path(args.folder, args.out)
    write_page(render(page), path, "report")
    return OK


def _page_path(folder: Path, out: Path | None) -> Path:
    """Return where the page goes, which is no other file of the run."""
    path = writable_file(out or folder / REPORT)
    for name in (RECORD, STORE, *RUN_FILES, *read_record(folder / RECORD)["files"]):
        if path.resolve() == (folder / name).resolve():
            raise ValueError(f"--out {path} is a file of the run, which the page would replace; choose another file")
    return path
