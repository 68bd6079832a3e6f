"""``fscm-bench sweep``: compute grids of one's own, with the errors of every model; nothing is judged."""

from __future__ import annotations

import argparse
from datetime import UTC, datetime
from pathlib import Path

import pandas as pd

from comparisons.cli.options import FAILED, OK, output
from comparisons.console.progress import log
from comparisons.curve_quantities import SHAPES
from comparisons.model import ComputationFailed
from comparisons.output.tables import by_case, relative_error, rich_table, statuses
from comparisons.registry import identify
from comparisons.runs.cases import TIERS, Grid, load_grids
from comparisons.runs.computation import add_jobs, add_out, add_retry_failed, checked_jobs, complete, folder_for
from comparisons.runs.rows import curve_frame, frame
from comparisons.runs.tables import write_curves, write_results, write_table
from comparisons.runs.tasks import plan

__all__ = ["add", "call"]


def add(parsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the arguments."""
    parser = parsers.add_parser("sweep", help="compute grids of one's own", description=__doc__)
    parser.add_argument(
        "file", metavar="FILE", type=Path, help="[[grid]] tables as in comparisons/data/cases.toml, without a tier"
    )
    parser.add_argument(
        "--model", metavar="SPEC", nargs="+", action="extend", help="ask these models instead of those each grid names"
    )
    add_jobs(parser)
    add_out(parser)
    add_retry_failed(parser)
    parser.set_defaults(call=call)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write and print; return the exit status."""
    jobs = checked_jobs(args.jobs)
    names, outside = identify(args.model or [])
    chosen = _grids(args.file)
    tasks = plan(chosen, names or None, outside)
    folder = folder_for(args.out, datetime.now(UTC))
    try:
        rows = complete(tasks, folder, jobs, args.retry_failed).rows
    except ComputationFailed as failure:
        log(str(failure))
        return FAILED
    table = frame(row for row in rows if row.quantity not in SHAPES)
    write_results(table, folder / "results")
    write_curves(curve_frame(row for row in rows if row.quantity in SHAPES), folder / "curves")
    kappa = pd.concat(
        [relative_error(table, reference) for reference in sorted({grid.reference for grid in chosen})],
        ignore_index=True,
    )
    write_table(kappa, folder / "kappa")
    console = output()
    for (quantity, reference), group in kappa.groupby(["quantity", "reference"]):
        shown, formats = by_case(group)
        title = f"{quantity} of {reference} with its u_num, and kappa of each model in percent"
        console.print(rich_table(shown, title, formats))
    for row in rows:
        if row.status == "failed":
            log(f"{row.model}: {row.quantity} at n = {row.n:g}, k = {row.k:g}, mu = {row.mu:g}: {row.reason}")
    console.print(rich_table(statuses(table), "computations"))
    log(f"results are in {folder}")
    return FAILED if any(row.status == "failed" for row in rows) else OK


def _grids(path: Path) -> list[Grid]:
    try:
        return load_grids(path.read_text(encoding="utf-8"), tier=TIERS[0], source=str(path))
    except OSError as error:
        raise ValueError(f"the file {path} cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise ValueError(f"the file {path} is not UTF-8 text") from None
