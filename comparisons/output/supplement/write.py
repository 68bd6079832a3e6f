"""Writing of a supplement: one folder with the document, its tables, figures and references, and the data."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

from comparisons.data.file_names import AGREEMENT, CURVES, KAPPA, RECORD, RUN_FILES
from comparisons.output.citation import as_bibtex, methods, works
from comparisons.output.errors import error_summary, ranked, within_ranges
from comparisons.output.figures.of_run import figures_of
from comparisons.output.latex import latex
from comparisons.output.region_table import region_table
from comparisons.output.report import tables as page_tables
from comparisons.output.report.stored_run import Stored
from comparisons.output.style import save
from comparisons.output.supplement.best_models import best_model_tables
from comparisons.output.supplement.data_package import data_package
from comparisons.output.supplement.document import DATA, DOCUMENT, FIGURES, REFERENCES, TABLES, document
from comparisons.output.table import Table, laid_out
from comparisons.runs.atomic_files import prepare_folder, write_file, write_json
from comparisons.runs.csv_format import read_table

#: The description of the data, and of the folder.
_PACKAGE, _README = "datapackage.json", "README.md"

_ABOUT = """# Supplement

Written by `fscm-bench supplement` from the results of

    {command}

* `{document}` is the document. Typeset it with `pdflatex`, `bibtex`, and `pdflatex` twice.
* `{tables}/` has its tables, `{figures}/` its figures, `{references}` its references.
* `{data}/` has the tables with every digit, and the record of the run; `{package}` states unit and meaning of each
  column and the SHA-256 of each file (Frictionless Data).
"""


def supplement_tables(stored: Stored) -> Iterator[Table]:
    """Yield the tables: the ranking with its bounds, maps of the nearest model, errors by region, and the models."""
    evaluations = stored.evaluations()
    if len(evaluations):
        summary = ranked(error_summary(within_ranges(evaluations)))
        ordered = summary.sort_values(["quantity", "reference", "size"], ignore_index=True)
        yield laid_out("summary", ordered, id="ranking")
        yield from best_model_tables(evaluations)
        if "mu" in stored.kappa_inside and len(stored.kappa_inside):
            yield region_table(stored.kappa_inside, ordered)
    yield page_tables.models(stored)


def write_supplement(stored: Stored, run: Path, out: Path) -> None:
    """Write the supplement of a finished run.

    Parameters
    ----------
    stored : Stored
        The content of the folder `run`.
    run, out : Path
        Folder of the run, and that of the supplement, which is new or empty.

    Raises
    ------
    ValueError
        If `out` is not empty, or cannot be written.
    """
    if out.is_dir() and any(out.iterdir()):
        raise ValueError(f"--out {out} is not empty: choose a new folder, because a file that is there may be yours")
    for name in (TABLES, FIGURES, DATA):
        prepare_folder(out / name)
    tables = {f"{table.id}.tex": table for table in supplement_tables(stored)}
    for name, table in tables.items():
        write_file(out / TABLES / name, latex(table.on_paper, table.caption, table.id))
    # By our names: those of a record would go into commands of LaTeX.
    kept = [name for name in RUN_FILES if name in stored.record["files"]]
    figures = _write_figures(kept, run, out / FIGURES)
    data = [name for name in kept if name.endswith(".csv")]
    for name in (*data, RECORD):
        shutil.copyfile(run / name, out / DATA / name)
    paragraph = methods(stored.record, _references(stored))
    write_file(out / DOCUMENT, document(paragraph, figures, tables))
    write_file(out / REFERENCES, as_bibtex(works("", stored.record)))
    write_json(data_package(stored.record, [out / DATA / name for name in data], DATA), out / _PACKAGE)
    names = {"document": DOCUMENT, "tables": TABLES, "figures": FIGURES, "references": REFERENCES, "data": DATA}
    command = " ".join(stored.record["command"])
    write_file(out / _README, _ABOUT.format(command=command, package=_PACKAGE, **names))


def _write_figures(kept: list[str], run: Path, folder: Path) -> list[str]:
    """Write each figure of a run as PDF, a copy or drawn from the tables of the run; return the names."""
    names = [Path(name).with_suffix(".pdf").name for name in kept if name.endswith(".png")]
    for name in names:
        if name in kept:
            shutil.copyfile(run / name, folder / name)
    missing = [name for name in names if name not in kept]
    if missing:
        tables = {name: read_table(run / f"{name}.csv") for name in (KAPPA, AGREEMENT, CURVES) if f"{name}.csv" in kept}
        for stem, figure in figures_of(tables):
            if f"{stem}.pdf" in missing:
                save(figure, folder / f"{stem}.pdf")
    return [name for name in names if (folder / name).exists()]


def _references(stored: Stored) -> dict[str, float]:
    """Return the models that were references, each with its largest relative bound."""
    bounds = stored.kappa["u_reference"] / stored.kappa["reference_value"].abs()
    return {str(name): float(of_name.max()) for name, of_name in bounds.groupby(stored.kappa["reference"])}
