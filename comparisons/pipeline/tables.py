"""Tables and pictures of a run, made of its rows and written into its folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from comparisons.data.file_names import AGREEMENT, CURVES, FIGURES, KAPPA, LARGEST_KAPPA, RESULTS, VALUES
from comparisons.output.errors import agreement, largest, relative_error
from comparisons.output.figures.of_run import draw_values, figures_of
from comparisons.output.style import save
from comparisons.pipeline.inputs import Cases
from comparisons.quantities import CURVES as CURVE_QUANTITIES
from comparisons.runs.csv_format import write_table
from comparisons.runs.frames import curve_frame, frame, in_case_order, keys_in, varied_of
from comparisons.runs.rows import Row
from comparisons.runs.tasks import plan

#: The two references, which are compared whenever a run has both.
REFERENCE, SECOND_REFERENCE = "fscm", "fem"


class RunTables(NamedTuple):
    """Tables of a run.

    Attributes
    ----------
    results, curves : DataFrame
        The rows, with the columns of `comparisons.runs.frames`.
    kappa : DataFrame
        Relative errors, as of `comparisons.output.errors.relative_error`.
    largest : DataFrame
        The largest of them, as of `comparisons.output.errors.largest`.
    agreement : DataFrame
        Differences of the two references; empty unless the run has both.
    """

    results: pd.DataFrame
    curves: pd.DataFrame
    kappa: pd.DataFrame
    largest: pd.DataFrame
    agreement: pd.DataFrame


def make_tables(rows: Sequence[Row], cases: Cases, models: list[str] | None) -> RunTables:
    """Return the tables of a run.

    Parameters
    ----------
    rows : sequence of Row
    cases : Cases
    models : list of str or None
        Models in place of those each grid names.
    """
    results = frame(row for row in rows if row.quantity not in CURVE_QUANTITIES)
    curves = curve_frame(row for row in rows if row.quantity in CURVE_QUANTITIES)
    kappa = _kappa(results, cases, models)
    return RunTables(results, curves, kappa, largest(kappa), agreement(results, SECOND_REFERENCE, REFERENCE))


def _kappa(results: pd.DataFrame, cases: Cases, models: list[str] | None) -> pd.DataFrame:
    """Return the relative errors over the grids that are not for the verification of the references."""
    tables = []
    for reference in dict.fromkeys(grid.reference for grid in cases.compared if grid.reference):
        keys = {task.key for task in plan((grid for grid in cases.compared if grid.reference == reference), models)}
        of_grids = [key in keys for key in keys_in(results)]
        # An empty list would select no columns.
        rows = results[pd.Series(of_grids, index=results.index, dtype=bool)]
        tables.append(_with_keys_of_files(relative_error(rows, reference), rows))
    return pd.concat(tables, ignore_index=True) if tables else relative_error(results.head(0), "")


def _with_keys_of_files(kappa: pd.DataFrame, results: pd.DataFrame) -> pd.DataFrame:
    """Return relative errors with the varied keys of problem files, and the unit of the values, as columns."""
    if "problem" not in kappa:
        return kappa
    varied, on = varied_of(results), ["quantity", "problem"]
    joined = kappa.merge(results[[*on, *varied, "unit"]].drop_duplicates(on), on=on)
    names = list(kappa.columns)
    # The keys beside their problem, the unit beside the value.
    for name, beside in (*((key, "problem") for key in reversed(varied)), ("unit", "u_num")):
        names.insert(names.index(beside) + 1, name)
    return in_case_order(joined[names], "quantity", "model")


def write_tables(tables: RunTables, folder: Path) -> None:
    """Write the tables as CSV."""
    for name, table in zip((RESULTS, CURVES, KAPPA, LARGEST_KAPPA, AGREEMENT), tables, strict=True):
        if name != AGREEMENT or len(table):
            write_table(table, folder / name)


def write_pictures(tables: RunTables, folder: Path, *, pdf: bool = False) -> None:
    """Draw the pictures of the standing cases, as far as there are rows for them, as PNG and perhaps also as PDF."""
    for name in FIGURES:
        # One of an earlier run of the folder could show other rows.
        (folder / f"{name}.pdf").unlink(missing_ok=True)
    for name, figure in figures_of({KAPPA: tables.kappa, AGREEMENT: tables.agreement, CURVES: tables.curves}):
        save(figure, *(folder / f"{name}{suffix}" for suffix in ((".png", ".pdf") if pdf else (".png",))))


def write_picture_of_values(tables: RunTables, folder: Path) -> None:
    """Draw the values over each varied number of a problem file, if there is one, as PNG."""
    picture = folder / f"{VALUES}.png"
    picture.unlink(missing_ok=True)
    if (figure := draw_values(tables.results)) is not None:
        save(figure, picture)
