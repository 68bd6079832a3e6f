"""``fscm-bench curve``: a force-displacement curve, or a surface at pull-off, by one model or several."""

from __future__ import annotations

import argparse
import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, cast

import lazy_loader
import numpy as np

from comparisons.cli.options import CASE_OR_FILE, MODEL_SPEC, command, file, option, problem_of, several
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log, note, waiting
from comparisons.data.plain_numbers import plain_float
from comparisons.model import Array, ComputationFailed, Model, NotApplicable
from comparisons.output import plots
from comparisons.output.figures.of_run import draw_plots
from comparisons.output.style import picture_path, save
from comparisons.problem import Problem
from comparisons.problem.evaluation import SOLVERS, evaluated, force_curve_to
from comparisons.problem.units import NotAValue, in_si, si_text
from comparisons.quantities import CURVES, Points
from comparisons.registry import create, identify
from comparisons.runs.atomic_files import writable_file, write_file
from comparisons.runs.csv_format import csv_text

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")

#: Share of the pull-off force at the beginning of a curve from which on it begins in contact.
_FAR = 0.1
#: A curve within this share of a load has reached it: a closed form inverts it with some roundings.
_AT_LOAD = 1.0 - 1e-9
_QUANTITY = f"what to draw: {', '.join(CURVES)} (default: force_curve)"

_STIFFNESS = 'approach and retreat as a cantilever of a stiffness as "0.2 N/m" records them'


@command(
    several("--model", metavar="SPEC", required=True, help=MODEL_SPEC),
    option("--quantity", metavar="NAME", choices=tuple(CURVES), default="force_curve", help=_QUANTITY),
    *CASE_OR_FILE,
    option(
        "--stiffness",
        metavar="VALUE",
        help=_STIFFNESS,
    ),
    option(
        "--max-load",
        metavar="VALUE",
        help='where a force curve ends in compression, as "50 nN" with --problem (default: at the pull-off force)',
    ),
    file("--csv", help="write the points to this file (default, and with -: stdout)"),
    file("--plot", help="draw the curves into this file (.png, .pdf or .svg)"),
)
def curve_command(args: argparse.Namespace) -> int:
    """Trace, write, draw; return the exit status.

    For example::

        fscm-bench curve --model fscm jkr --n 2 --k 0.4 --mu 3 --plot curve.png --csv curve.csv
        fscm-bench curve --model fscm jkr --problem pad.toml --max-load '50 nN' --plot pad.png
        fscm-bench curve --model fscm jkr --problem probe.toml --stiffness '0.2 N/m' --csv cycle.csv
    """
    problem = problem_of(args)
    stiffness, max_load = _stiffness(args, problem), _max_load(args, problem)
    # All that can be wrong with the request is found out before anything is computed.
    names, external = identify(args.model)
    models = {name: create(external[name].spec if name in external else name, problem.nu) for name in names}
    to_stdout = args.csv == Path("-") or not (args.csv or args.plot)
    file_of_points = None if to_stdout else args.csv
    for path in filter(None, (file_of_points, args.plot and picture_path(args.plot))):
        writable_file(path)
    if file_of_points and args.plot and file_of_points.resolve() == args.plot.resolve():
        raise ValueError(f"--csv and --plot are both {args.plot}: one would replace the other; give two files")
    points_of_models, status = _evaluated(models, args.quantity, problem, max_load)
    quantity = CURVES[args.quantity] if problem.is_dimensionless else CURVES[args.quantity].in_si
    if stiffness is None:
        points = _table(points_of_models, args.quantity)
        table = points if problem.is_dimensionless else points.rename(columns=quantity.columns_in_si)
        drawn = points.rename(columns={quantity.x.name: "x", quantity.y.name: "y"})
        if max_load is not None:
            _note_contact_radii(points, problem)
    else:
        table, failed = _cycles(points_of_models, stiffness)
        status = FAILED if failed else status
        drawn = table.rename(columns={"position [m]": "x", "load [N]": "y"})
        quantity = replace(quantity, x=replace(quantity.x, title="position of the cantilever's base", symbol="x"))
    if file_of_points:
        write_file(file_of_points, csv_text(table))
    if args.plot:
        plot = plots.curve(quantity, drawn.assign(case=problem.label))
        # By default the tension fills the figure; who names a load wants to see it.
        save(draw_plots([plot if max_load is None else replace(plot, views={})]), args.plot)
    if to_stdout:
        print(csv_text(table), end="")
    for path in filter(None, (file_of_points, args.plot)):
        note(f"the {'curve' if stiffness is None else 'cycle'} is in {path}")
    if stiffness is None and not problem.is_dimensionless and args.quantity == "force_curve":
        note("this is the whole equilibrium path; --stiffness '1 N/m' gives approach and retreat, with their jumps")
        _note_assumptions(problem, points_of_models)
    return status


def _stiffness(args: argparse.Namespace, problem: Problem) -> float | None:
    """Return the stiffness in N/m; the cycle of a cantilever is a curve over its position in m."""
    if args.stiffness is None:
        return None
    if problem.is_dimensionless:
        raise ValueError("--stiffness is that of a cantilever in N/m: give the contact as a file with --problem")
    if args.quantity != "force_curve":
        raise ValueError(f"--stiffness is of a force curve: omit --quantity {args.quantity}")
    value = _in_si("--stiffness", args.stiffness, "N/m")
    if not value > 0.0:
        raise ValueError(f"--stiffness {args.stiffness} is not above 0: a cantilever resists its deflection")
    return value


def _max_load(args: argparse.Namespace, problem: Problem) -> float | None:
    """Return the load at the end of a force curve, in N or dimensionless as the problem is."""
    if args.max_load is None:
        return None
    if args.quantity != "force_curve":
        raise ValueError(f"--max-load ends a force curve: omit --quantity {args.quantity}")
    value = plain_float(args.max_load) if problem.is_dimensionless else _in_si("--max-load", args.max_load, "N")
    if not 0.0 < value < math.inf:
        raise ValueError(f"--max-load {args.max_load} is not in (0, inf): a curve ends in compression")
    return value


def _in_si(option_name: str, text: str, unit: str) -> float:
    try:
        return in_si(text, unit)
    except NotAValue as error:
        raise ValueError(f"{option_name} {text} {error}") from None


def _cycles(points_of_models: dict[str, Points], stiffness: float) -> tuple[pd.DataFrame, bool]:
    """Return the points of the cycles, and whether one failed; the jumps are named on stderr."""
    # Imported here: other curves do not need it.
    from comparisons.fitting.equilibria import Equilibria
    from comparisons.fitting.machine import Machine

    columns = ("model", "branch", "position [m]", "displacement [m]", "load [N]")
    frames, failed = [], False
    for name, points in points_of_models.items():
        try:
            machine = Machine.of(Equilibria(*_from_afar(points)), stiffness)
            cycle = machine.cycle()
        except ComputationFailed as failure:
            log(f"{name}: failed: {failure}")
            failed = True
            continue
        ends = {"snaps in": machine.far[:, -1], "snaps out": machine.contact[:, 0]}
        jumps = (f"{word} where its base is at {_short(x, 'm')}, at {_short(y, 'N')}" for word, (x, y) in ends.items())
        said = [*(jumps if machine.jumps else ["no jumps"]), f"pull-off force {_short(-min(points.y), 'N')}"]
        note(f"{name}: {', '.join(said)}")
        for branch, (position, load) in cycle.items():
            values = (name, branch, position, position - load / stiffness, load)
            frames.append(pd.DataFrame(dict(zip(columns, values, strict=True))))
    return (pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=columns)), failed


def _from_afar(points: Points) -> tuple[Array, Array]:
    """Return displacement and load; a model of the contact alone has no load before it."""
    displacement, load = np.array(points.x), np.array(points.y)
    if displacement[1] > displacement[0] and load[0] >= _FAR * load.min():
        return displacement, load
    far = displacement[0] - np.ptp(displacement)
    return np.concatenate([[far, displacement[0]], displacement]), np.concatenate([[0.0, 0.0], load])


def _short(value: float, unit: str) -> str:
    return si_text(float(f"{value:.4g}"), 0.0, unit)


def _evaluated(
    models: dict[str, Model], quantity: str, problem: Problem, max_load: float | None
) -> tuple[dict[str, Points], int]:
    """Return the points of the models that have them, and the exit status; the others are named on stderr."""
    points_of_models: dict[str, Points] = {}
    status = OK
    for name, model in models.items():
        try:
            with waiting(f"solving {problem.label} with {name}", is_long=name in SOLVERS):
                if max_load is None:
                    points = cast(Points, evaluated(problem, model, quantity))
                else:
                    points = force_curve_to(problem, model, max_load)
            points_of_models[name] = points
            if max_load is not None and points.y[-1] < _AT_LOAD * max_load:
                log(f"{name}: its curve ends below --max-load, at {_in_units(points.y[-1], problem)}")
        except NotApplicable as refusal:
            log(f"{name}: not-applicable: {refusal}")
        except ComputationFailed as failure:
            log(f"{name}: failed: {failure}")
            status = FAILED
    return points_of_models, status


def _in_units(load: float, problem: Problem) -> str:
    return f"{load:.4g}" if problem.is_dimensionless else _short(load, "N")


def _note_contact_radii(points: pd.DataFrame, problem: Problem) -> None:
    """Note the contact radius at the end of each curve on stderr."""
    for name, last in points.groupby("model", sort=False).last(skipna=False).iterrows():
        if not math.isnan(radius := float(last["contact_radius"])):
            text = f"{radius:.6g}" if problem.is_dimensionless else si_text(float(f"{radius:.6g}"), 0.0, "m")
            note(f"{name}: contact radius {text} at a load of {_in_units(last['load'], problem)}")


def _note_assumptions(problem: Problem, points_of_models: dict[str, Points]) -> None:
    """Note the error by the assumptions on stderr: stdout and the file have points alone."""
    # Imported here: problems without a file do not need the table of balls.
    from comparisons.description.budget import budget, largest_line

    # The bound of a curve is a share of its ranges.
    line = largest_line((budget(problem, name), points.u_distance, "") for name, points in points_of_models.items())
    if line:
        note(line)


def _table(points_of_models: dict[str, Points], quantity: str) -> pd.DataFrame:
    """One row a point, in the order of each path; a column that a model does not know is empty.

    The contact radius of a model with a cohesive edge is that of the largest tension.
    """
    x, y = CURVES[quantity].x.name, CURVES[quantity].y.name
    frames = []
    for name, points in points_of_models.items():
        radius = {"contact_radius": points.columns["edge_radius"]} if "edge_radius" in points.columns else {}
        frames.append(pd.DataFrame({"model": name, x: points.x, y: points.y, **points.columns, **radius}))
    return pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=["model", x, y])
