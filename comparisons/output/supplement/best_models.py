"""The model nearest to its reference in each case, as a map over the Tabor number and the gradient exponent."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from comparisons.judging.standing import shared_ranks
from comparisons.numerics.number_text import exact, short_percent
from comparisons.output.table import Table, column
from comparisons.quantities import title_of
from comparisons.runs.frames import with_problem


def best_model_tables(evaluations: pd.DataFrame) -> Iterator[Table]:
    """Yield a table for each quantity, reference and punch: rows of Tabor numbers, a column for each gradient exponent.

    A cell has the models whose largest error in the case is the smallest, with that error in percent; several where the
    bounds on the numerical errors do not decide.  A model counts within the range that it declares.  Cases of problem
    files have no place in the map.

    Parameters
    ----------
    evaluations : DataFrame
        As `comparisons.output.report.stored_run.Stored.evaluations` returns them.
    """
    rows = with_problem(evaluations)
    is_known = rows["inside"] & rows["kappa"].notna() & (rows["problem"].fillna("") == "")
    for (quantity, reference, n), group in rows[is_known].groupby(["quantity", "reference", "n"], sort=False):
        best = group.groupby(["mu", "k"])[["model", "kappa", "u_kappa"]].apply(_nearest).unstack("k")
        exponents = {f"k = {exact(k)}": k for k in best.columns}
        layout = [column("μ", "mu", "exact"), *(column(heading, heading) for heading in exponents)]
        stored = best.set_axis(list(exponents), axis="columns").reset_index()
        caption = f"Nearest model and its κ in percent: {title_of(str(quantity))}, n = {exact(n)}, against {reference}"
        yield Table(f"best-{quantity}-{reference}-{exact(n)}", caption, layout, stored)


def _nearest(case: pd.DataFrame) -> str:
    """Return the models of the first rank in a case, each by its largest error, with the first of these errors."""
    errors = case.loc[case["kappa"].abs().groupby(case["model"]).idxmax()]
    ranks = shared_ranks(errors["kappa"].abs().tolist(), errors["u_kappa"].tolist())
    first = errors[[rank == 1 for rank in ranks]].sort_values("kappa", key=abs)
    return f"{', '.join(first['model'])} ({short_percent(first['kappa'].iloc[0])})"
