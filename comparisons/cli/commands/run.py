"""``fscm-bench run``: compute the standing cases, judge them, and write verdicts, tables and figures."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Mapping
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path

import pandas as pd
from rich.table import Table

from comparisons.cli.commands.judge import GATES, STATUS, counted, judge_and_write, load_user_gates, print_verdicts
from comparisons.cli.options import FAILED, output
from comparisons.console.progress import log
from comparisons.curve_quantities import SHAPES
from comparisons.judging.decision import roll_up
from comparisons.judging.gates import gates_text, load_gates, of_tier
from comparisons.model import ComputationFailed
from comparisons.output.figures import agreement as agreement_figure
from comparisons.output.figures import kappa as kappa_figure
from comparisons.output.figures import references
from comparisons.output.markdown import to_step_summary
from comparisons.output.style import save
from comparisons.output.tables import (
    agreement,
    beside_paper_values,
    by_case,
    largest,
    largest_by_gradient,
    relative_error,
    rich_table,
    statuses,
)
from comparisons.registry import ExternalIdentity, create, identify
from comparisons.runs.atomic_files import atomic
from comparisons.runs.cases import TIERS, VERIFICATION, Grid, cases_text, grids, grids_for
from comparisons.runs.computation import add_jobs, add_out, add_retry_failed, checked_jobs, complete, folder_for
from comparisons.runs.environment import environment
from comparisons.runs.record import FORMAT, write_record
from comparisons.runs.rows import Row, curve_frame, frame
from comparisons.runs.tables import write_curves, write_results, write_table
from comparisons.runs.tasks import plan

__all__ = ["add", "call"]

#: The two truths, which are compared whenever a run has both.
REFERENCE, SECOND_REFERENCE = "fscm", "fem"


def add(parsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the arguments."""
    parser = parsers.add_parser("run", help="compute the standing cases and judge them", description=__doc__)
    parser.add_argument("--tier", choices=TIERS, default=TIERS[0], help="how much to compute (default: %(default)s)")
    parser.add_argument(
        "--model",
        metavar="SPEC",
        nargs="+",
        action="extend",
        help="compare these models instead of those each grid names",
    )
    parser.add_argument("--gates", metavar="FILE", type=Path, help="judge by these gates instead of the standing ones")
    add_jobs(parser)
    add_out(parser)
    add_retry_failed(parser)
    parser.set_defaults(call=call)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write and print; return the exit status."""
    jobs = checked_jobs(args.jobs)
    # Before anything is computed or written, every model that was asked for has been opened.
    names, outside = identify(args.model or [])
    given = None if args.model is None else names
    specs = {name: model.spec for name, model in outside.items()}
    rules = gates_text(args.gates)
    chosen = grids_for(grids(args.tier), given)
    gates = (
        of_tier(load_gates(rules), args.tier)
        if args.gates is None
        else load_user_gates(rules, args.gates, args.tier, chosen, given)
    )
    started = datetime.now(UTC)
    to_step_summary("")
    folder = folder_for(args.out, started)
    if (folder / GATES).exists() and not (folder / "journal.jsonl").exists() and gates_text(folder / GATES) != rules:
        raise ValueError(f"{folder / GATES} is not of a run, which would replace it; choose another folder with --out")
    tasks = plan(chosen, given, outside)
    try:
        completed = complete(tasks, folder, jobs, args.retry_failed)
    except ComputationFailed as failure:
        log(str(failure))
        return FAILED
    rows = completed.rows
    table = frame(row for row in rows if row.quantity not in SHAPES)
    curves = curve_frame(row for row in rows if row.quantity in SHAPES)
    kappa = _kappa(table, chosen, given)
    maxima = largest(kappa)
    _write(folder, table, curves, kappa, maxima)
    with atomic(folder / GATES) as file:
        file.write(rules.encode())
    judged = judge_and_write(folder, gates, chosen, table, curves, given, specs)
    verdict = roll_up(judged["verdict"])
    write_record(
        {
            "format": FORMAT,
            "arguments": {
                "tier": args.tier,
                "model": given,
                "outside": specs,
                "gates": None if args.gates is None else str(args.gates),
                "jobs": jobs,
                "out": str(folder),
            },
            "command": [Path(sys.argv[0]).name, *sys.argv[1:]],
            "started": completed.parts[0]["started"] if completed.parts else started.isoformat(timespec="seconds"),
            "finished": datetime.now(UTC).isoformat(timespec="seconds"),
            "seconds": {"run": sum(part["seconds"] for part in completed.parts), "by_model": _seconds(rows)},
            "parts": completed.parts,
            **({"evaluated_again": completed.evaluated_again} if completed.evaluated_again else {}),
            "models": _described({task.model for task in tasks}, outside),
            "rows": {"all": len(rows), "resumed": completed.resumed, **Counter(row.status for row in rows)},
            "cases_sha256": sha256(cases_text().encode()).hexdigest(),
            "gates_sha256": sha256(rules.encode()).hexdigest(),
            "verdicts": counted(judged),
            **environment(),
        },
        folder / "run.json",
    )
    _print(table, kappa, maxima)
    print_verdicts(judged, specs)
    if failed := sum(row.status == "failed" for row in rows):
        log(f"{failed} computations failed")
    log(f"results are in {folder}")
    return FAILED if failed else STATUS[verdict]


def _kappa(table: pd.DataFrame, chosen: list[Grid], models: list[str] | None) -> pd.DataFrame:
    """Return the relative errors over the grids that are not about the references themselves."""
    shown = [grid for grid in chosen if VERIFICATION not in grid.tags]
    tables = []
    for reference in sorted({grid.reference for grid in shown}):
        keys = {task.key for task in plan((g for g in shown if g.reference == reference), models)}
        mine = [
            (*row[:5], None if pd.isna(row[5]) else row[5]) in keys
            for row in table[["model", "quantity", "n", "k", "mu", "nu"]].itertuples(index=False)
        ]
        tables.append(relative_error(table[mine], reference))
    return pd.concat(tables, ignore_index=True)


def _described(names: set[str], outside: Mapping[str, ExternalIdentity]) -> dict[str, dict[str, str]]:
    """Return what each model says of itself."""
    models = {name: outside.get(name) or create(name) for name in sorted(names)}
    described = {
        name: {"version": model.version, "citation": model.citation, "domain": model.domain}
        for name, model in models.items()
    }
    for name, model in outside.items():
        if hashed := getattr(model, "hashed", ""):
            described[name]["hashed"] = hashed
    return described


def _seconds(rows: list[Row]) -> dict[str, float]:
    """Return the computing time summed over the processes, by model."""
    seconds: Counter[str] = Counter()
    for row in rows:
        seconds[row.model] += row.seconds  # type: ignore[assignment]
    return dict(sorted(seconds.items()))


def _write(folder: Path, table: pd.DataFrame, curves: pd.DataFrame, kappa: pd.DataFrame, maxima: pd.DataFrame) -> None:
    write_results(table, folder / "results")
    write_curves(curves, folder / "curves")
    write_table(kappa, folder / "kappa")
    write_table(maxima, folder / "largest_kappa")
    figures = {}
    # A run of other models has nothing of what the figure shows.
    if not kappa_figure.shown(kappa).empty:
        figures["fig16b_kappa"] = kappa_figure.draw(kappa)
    apart = agreement(table, SECOND_REFERENCE, REFERENCE)
    if not apart.empty:
        write_table(apart, folder / "agreement")
        figures["agreement"] = agreement_figure.draw(apart)
    if not curves.empty:
        figures["references"] = references.draw(curves)
    for name, figure in figures.items():
        for suffix in (".png", ".pdf"):
            save(figure, folder / f"{name}{suffix}")


def _print(table: pd.DataFrame, kappa: pd.DataFrame, maxima: pd.DataFrame) -> None:
    """Print the details first: what is read first on a terminal is what was printed last."""
    console = output()
    for (quantity, reference), group in kappa.groupby(["quantity", "reference"]):
        title = f"{quantity} of {reference} with its u_num, and kappa of each model in percent"
        console.print(_titled(by_case(group), title))
    troubles = table.loc[table["status"] == "failed", ["model", "quantity", "n", "k", "mu", "reason"]]
    if len(troubles):
        console.print(rich_table(troubles, "failed computations"))
    console.print(rich_table(statuses(table), "computations"))
    console.print(_titled(largest_by_gradient(maxima), "largest abs(kappa) in percent"))
    stated = beside_paper_values(maxima)
    if not stated[0].empty:
        title = "largest abs(kappa) in percent beside the published (at_end: at an end of the range of mu)"
        console.print(_titled(stated, title))


def _titled(shown: tuple[pd.DataFrame, dict[str, str]], title: str) -> Table:
    table, formats = shown
    return rich_table(table, title, formats)
