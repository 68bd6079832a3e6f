"""``fscm-bench cite``: how to cite fscm-bench and what a run used, as text or BibTeX.

For example::

    fscm-bench cite
    fscm-bench cite --format bibtex results/runs/TIME
"""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.cli.options import file, output_format
from comparisons.console.exit_status import OK
from comparisons.console.printable import printable
from comparisons.data.file_names import KAPPA, RECORD
from comparisons.output.citation import as_bibtex, as_text, methods, works
from comparisons.runs.csv_format import read_table
from comparisons.runs.environment import version_text
from comparisons.runs.record import check_files, read_record

_FOLDER = "folder of a finished run, sweep or comparison, to cite the versions and models that it used"

OPTIONS = (
    file("folder", metavar="DIR", nargs="?", help=_FOLDER),
    output_format("bibtex", help="text has a paragraph for the Methods section and the references (default: text)"),
)


def call(args: argparse.Namespace) -> int:
    """Print the citation; return the exit status."""
    record, paragraph = None, ""
    if args.folder is not None:
        record = read_record(args.folder / RECORD)
        check_files(record, args.folder)
        paragraph = methods(record, _references(args.folder / f"{KAPPA}.csv"))
    cited = works("" if record else version_text(), record)
    print(printable(as_bibtex(cited) if args.format == "bibtex" else as_text(cited, paragraph)), end="")
    return OK


def _references(table: Path) -> dict[str, float]:
    """The models that were references, each with its largest relative bound; empty without errors."""
    if not table.is_file():
        return {}
    rows = read_table(table)
    relative = rows["u_reference"] / rows["reference_value"].abs()
    return {str(name): float(bounds.max()) for name, bounds in relative.groupby(rows["reference"])}
