"""Functions that compare models with a reference: a run folder with one table and one figure, or errors alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from comparisons.data.file_names import COMPARISON, RECORD
from comparisons.data.validation import known_name
from comparisons.description.budget import line_of_results
from comparisons.model import Model
from comparisons.output.errors import comparison_table, error_summary, relative_error
from comparisons.output.figures.of_run import draw_comparison
from comparisons.output.latex import UPRIGHT_WIDTH, latex, put_together
from comparisons.output.markup import html_table
from comparisons.output.style import save
from comparisons.output.summaries import WIDTH, case_tables, side_by_side, summary_tables, terminal_tables
from comparisons.output.terminal import plain_text
from comparisons.pipeline.inputs import Cases, cases_of_problem, grid_text, load_cases
from comparisons.pipeline.run import running
from comparisons.problem import Problem
from comparisons.problem.evaluation import REFERENCES
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.registry import COMPARABLE, create
from comparisons.runs.csv_format import write_table
from comparisons.runs.frames import frame
from comparisons.runs.record import read_record, write_record
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: In place of a name: every model of fscm-bench that is not only a check of `fscm`.
ALL = "all"


@dataclass(frozen=True, slots=True, repr=False)
class Comparison:
    """Models beside a reference.

    Attributes
    ----------
    table : DataFrame
        One row for each quantity, case and model (`comparisons.output.errors.comparison_table`).
    summary : DataFrame
        One row for each quantity and model: coverage, largest and root mean square error
        (`comparisons.output.errors.error_summary`).
    folder : Path
        The run folder, with `table` and `figure` as ``comparison.csv``, ``.png`` and ``.pdf``.
    failures : tuple of Row
        The rows of computations that failed.
    assumptions : str or None
        A line on the error of the pull-off force by the assumptions of all models (`comparisons.description.budget`).
    """

    table: pd.DataFrame
    summary: pd.DataFrame
    folder: Path
    failures: tuple[Row, ...]
    assumptions: str | None = None

    def figure(self) -> Figure:
        """Return the errors as a Matplotlib figure."""
        return draw_comparison(self.table)

    def latex(self) -> str:
        """Return the tables in LaTeX, with as many models side by side as a page has room for."""
        tables = [
            latex(texts, cases.caption, f"{cases.id}-{number}")
            for cases in case_tables(self.table)
            for number, texts in enumerate(side_by_side(cases, UPRIGHT_WIDTH), start=1)
        ]
        summaries = (latex(table.texts, table.caption, table.id) for table in summary_tables(self.summary))
        return put_together([*tables, *summaries])

    def __repr__(self) -> str:
        return plain_text(terminal_tables(self.table, self.summary), WIDTH)

    def _repr_html_(self) -> str:
        return "\n".join(map(html_table, [*summary_tables(self.summary), *case_tables(self.table)]))


def compare(
    models: str | Iterable[str],
    grid: str | Path | None = None,
    *,
    problem: str | Path | None = None,
    vary: Sequence[str] = (),
    n: float | Sequence[float] | None = None,
    k: float | Sequence[float] | None = None,
    mu: float | Sequence[float] | None = None,
    nu: float | Sequence[float] | None = None,
    quantities: str | Sequence[str] = ("pull_off_force",),
    reference: str | None = None,
    folder: str | Path | None = None,
    jobs: int = 1,
) -> Comparison:
    """Compute models and the reference in your own cases, and compare them.

    Parameters
    ----------
    models : iterable of str
        Names or SPECs, or "all" for every model of fscm-bench that has a value or a failure in one of the cases.
    grid : str or Path, optional
        A sweep file (of [[grid]] tables), or its text.  It states the quantities and the references.
    problem : str or Path, optional
        A problem file in place of a grid.
    vary : sequence of str
        Values of its keys, as ``"solid.thickness=5, 10 nm"``: every combination is a case.
    n, k, mu : float or sequence of float
        Without a grid or a file: every combination is a case.
    nu : float or sequence of float, optional
        Poisson's ratios, for models that need one.
    quantities : str or sequence of str
        Numbers, not curves, as in `comparisons.quantities.QUANTITIES`.
    reference : str, optional
        A model: "fscm" by default; "atlas" takes microseconds and has no value outside its range.
    folder : str or Path, optional
        For the results; by default results/runs/TIME.  Results in it are not computed again.
    jobs : int
        Number of processes.  With more than one, a script needs the guard ``if __name__ == "__main__":``.

    Raises
    ------
    ValueError
        If an argument is not admissible, or the folder holds results of other code or files of a user.
    comparisons.model.ComputationFailed
        If the workers cannot compute.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     compared = compare(["jkr", "bradley"], n=2, k=0, mu=1, reference="atlas", folder=Path(folder))
    >>> compared.table[["model", "kappa"]].round(4).values.tolist()
    [['jkr', -0.1022], ['bradley', 0.1971]]
    """
    named = [models] if isinstance(models, str) else list(models)
    specs = [*named] if ALL not in named else [*(spec for spec in named if spec != ALL), *COMPARABLE]
    if not specs:
        raise ValueError("no model is named; a comparison needs at least one")
    numbers = {name: _several(values) for name, values in {"n": n, "k": k, "mu": mu, "nu": nu}.items()}
    asked = [quantities] if isinstance(quantities, str) else list(quantities)
    cases = _cases(grid, problem, vary, numbers, asked, reference)
    _check(cases, specs)
    with running(cases, models=specs, folder=folder, jobs=jobs) as finished:
        table = comparison_table(finished.tables.results, finished.inputs.cases.grids, finished.inputs.models)
        if ALL in named:
            table = _of_applicable(table, named)
        problems = (case for grid in finished.inputs.cases.grids for case in grid.cases)
        line = line_of_results(problems, finished.tables.results)
        comparison = Comparison(table, error_summary(table), finished.folder, finished.failures, line)
        write_table(table, finished.folder / COMPARISON)
        save(comparison.figure(), *(finished.folder / f"{COMPARISON}{suffix}" for suffix in (".png", ".pdf")))
        # With the checksums of these files.
        write_record(read_record(finished.folder / RECORD), finished.folder / RECORD)
    return comparison


def _several(values: float | Sequence[float] | None) -> list[float] | None:
    """Several numbers, or a single one as a list of one."""
    if values is None:
        return None
    return [values] if isinstance(values, Real) else list(values)  # type: ignore[list-item,arg-type]  # a Real is a float here


def _cases(
    grid: str | Path | None,
    problem: str | Path | None,
    vary: Sequence[str],
    numbers: Mapping[str, Sequence[float] | None],
    quantities: Sequence[str],
    reference: str | None,
) -> Cases:
    """Return the cases of a grid, of a problem file, or of numbers."""
    if problem is not None:
        if grid is not None or any(values is not None for values in numbers.values()):
            raise ValueError("--problem states the case; leave out --grid, --n, --k, --mu and --nu")
        compared_with = reference or REFERENCES[0]
        return cases_of_problem(Path(problem), vary, [compared_with], quantities, compared_with)
    if vary:
        raise ValueError("--vary is for the keys of --problem FILE, which is missing")
    if grid is None:
        if missing := [name for name in ("n", "k", "mu") if numbers[name] is None or not len(numbers[name] or ())]:
            raise ValueError(f"the cases need --{' and --'.join(missing)}, or --grid FILE, or --problem FILE")
        grid = grid_text(
            id="comparison",
            title=f"Comparison with {reference or REFERENCES[0]}",
            reference=reference or REFERENCES[0],
            models=[reference or REFERENCES[0]],
            quantities=quantities,
            **{name: [float(value) for value in values or ()] for name, values in numbers.items()},
        )
    elif reference is not None or any(values is not None for values in numbers.values()):
        raise ValueError("--grid states the cases and the references; leave out --n, --k, --mu, --nu and --reference")
    return load_cases(grid, None)


def _of_applicable(table: pd.DataFrame, named: Sequence[str]) -> pd.DataFrame:
    """Return the rows of a comparison without models that are applicable in no case and have not been named."""
    applicable = table.loc[table["status"] != "not-applicable", "model"]
    kept = table["model"].isin([*applicable, *named]) | ~table["model"].isin(COMPARABLE)
    return table[kept].reset_index(drop=True)


def _check(cases: Cases, specs: Sequence[str]) -> None:
    """Refuse what cannot be compared, before anything is computed."""
    for grid in cases.grids:
        if curves := [quantity for quantity in grid.quantities if quantity in CURVES]:
            raise ValueError(
                f"the grid {grid.id} has the curve {curves[0]}: a comparison is of numbers; "
                "fscm-bench sweep computes curves, and a gate of the metric curve compares them"
            )
        if set(specs) <= {grid.reference}:
            raise ValueError(
                f"{grid.reference} is the reference of the grid {grid.id}: name a model to compare with it"
            )


def errors(
    models: Iterable[Model | str], cases: Iterable[Problem], quantity: str = "pull_off_force", reference: str = "fscm"
) -> pd.DataFrame:
    """Return kappa = (model - reference) / abs(reference) of every model in every case, with its uncertainty.

    Parameters
    ----------
    models : iterable of Model or str
        Models, or the names of models; the reference may be one of them.
    cases : iterable of Problem
    quantity : str
        A key of `comparisons.quantities.QUANTITIES`.
    reference : str
        The name of the model that the others are compared with.

    Returns
    -------
    DataFrame
        As `comparisons.output.errors.relative_error`: one row for each model and case where both have a value.

    Raises
    ------
    ValueError
        If a model, a case or the quantity is not admissible.

    Examples
    --------
    >>> table = errors(["jkr"], [Problem.dimensionless(n=2, k=0, mu=1)], reference="bradley")
    >>> table["kappa"].round(6).tolist()
    [-0.25]
    """
    known_name("quantity", quantity, QUANTITIES, "errors")
    created = [create(model) if isinstance(model, str) else model for model in models]
    by_name = {model.name: model for model in created}
    if reference not in by_name:
        by_name[reference] = create(reference)
    rows = [evaluate(model, quantity, case) for case in cases for model in by_name.values()]
    return relative_error(frame(rows), reference)
