"""``fscm-bench curve``: a force-displacement curve, or a surface at pull-off, by one model or several."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import cast

import pandas as pd

from comparisons.cli.options import CASE_OR_FILE, MODEL_SPEC, command, file, option, problem_of, several
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log, note, waiting
from comparisons.model import ComputationFailed, Model, NotApplicable
from comparisons.output import plots
from comparisons.output.figures.of_run import draw_plots
from comparisons.output.style import picture_path, save
from comparisons.problem import Problem
from comparisons.problem.evaluation import evaluated
from comparisons.quantities import CURVES, Points
from comparisons.registry import create, identify
from comparisons.runs.atomic_files import writable_file, write_file
from comparisons.runs.csv_format import csv_text

_QUANTITY = f"what to draw: {', '.join(CURVES)} (default: force_curve)"


@command(
    several("--model", metavar="SPEC", required=True, help=MODEL_SPEC),
    option("--quantity", metavar="NAME", choices=tuple(CURVES), default="force_curve", help=_QUANTITY),
    *CASE_OR_FILE,
    file("--csv", help="write the points to this file (default, and with -: stdout)"),
    file("--plot", help="draw the curves into this file (.png, .pdf or .svg)"),
)
def curve_command(args: argparse.Namespace) -> int:
    """Trace, write, draw; return the exit status.

    For example::

        fscm-bench curve --model fscm jkr --n 2 --k 0.4 --mu 3 --plot curve.png --csv curve.csv
        fscm-bench curve --model fscm fem --problem pad.toml --plot pad.png
    """
    problem = problem_of(args)
    # All that can be wrong with the request is found out before anything is computed.
    names, external = identify(args.model)
    models = {name: create(external[name].spec if name in external else name, problem.nu) for name in names}
    to_stdout = args.csv == Path("-") or not (args.csv or args.plot)
    file_of_points = None if to_stdout else args.csv
    for path in filter(None, (file_of_points, args.plot and picture_path(args.plot))):
        writable_file(path)
    if file_of_points and args.plot and file_of_points.resolve() == args.plot.resolve():
        raise ValueError(f"--csv and --plot are both {args.plot}: one would replace the other; give two files")
    points_of_models, status = _evaluated(models, args.quantity, problem)
    points, quantity = _table(points_of_models, args.quantity), CURVES[args.quantity]
    axes = {quantity.x.name: "x", quantity.y.name: "y"}
    table = points if problem.is_dimensionless else points.rename(columns=quantity.columns_in_si)
    if file_of_points:
        write_file(file_of_points, csv_text(table))
    if args.plot:
        rows = points.rename(columns=axes).assign(case=problem.label)
        save(draw_plots([plots.curve(quantity if problem.is_dimensionless else quantity.in_si, rows)]), args.plot)
    if to_stdout:
        print(csv_text(table), end="")
    for path in filter(None, (file_of_points, args.plot)):
        note(f"the curve is in {path}")
    if not problem.is_dimensionless and args.quantity == "force_curve":
        _note_assumptions(problem, points_of_models)
    return status


def _evaluated(models: dict[str, Model], quantity: str, problem: Problem) -> tuple[dict[str, Points], int]:
    """Return the points of the models that have them, and the exit status; the others are named on stderr."""
    points_of_models: dict[str, Points] = {}
    status = OK
    for name, model in models.items():
        try:
            with waiting(f"{name}, {problem.label}"):
                points_of_models[name] = cast(Points, evaluated(problem, model, quantity))
        except NotApplicable as refusal:
            log(f"{name}: not-applicable: {refusal}")
        except ComputationFailed as failure:
            log(f"{name}: failed: {failure}")
            status = FAILED
    return points_of_models, status


def _note_assumptions(problem: Problem, points_of_models: dict[str, Points]) -> None:
    """Note the error by the assumptions on stderr: stdout and the file have points alone."""
    # Imported here: problems without a file do not need the table of balls.
    from comparisons.description.budget import budget, largest_line

    # The bound of a curve is a share of its ranges.
    line = largest_line((budget(problem, name), points.u_distance, "") for name, points in points_of_models.items())
    if line:
        note(line)


def _table(points_of_models: dict[str, Points], quantity: str) -> pd.DataFrame:
    """One row a point, in the order of each path; a column that a model does not know is empty."""
    x, y = CURVES[quantity].x.name, CURVES[quantity].y.name
    frames = [
        pd.DataFrame({"model": name, x: points.x, y: points.y, **points.columns})
        for name, points in points_of_models.items()
    ]
    return pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=["model", x, y])
