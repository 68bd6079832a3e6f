"""``fscm-bench cite``: how to cite fscm-bench and what a run used."""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.cli.options import command, file, output_format
from comparisons.console.exit_status import OK
from comparisons.console.printable import printable
from comparisons.data.file_names import KAPPA, RECORD
from comparisons.output.citation import as_bibtex, as_text, methods, works
from comparisons.runs.environment import version_text

_CITED = "folder of a finished run, sweep or comparison, to cite the versions and models that it used"


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
        # Imported here, as in `_references`: without a folder there is no table to read.
        from comparisons.runs.record import check_files, read_record

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
    from comparisons.runs.csv_format import read_table

    rows = read_table(table)
    relative = rows["u_reference"] / rows["reference_value"].abs()
    return {str(name): float(bounds.max()) for name, bounds in relative.groupby(rows["reference"])}
