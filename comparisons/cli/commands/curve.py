"""``fscm-bench curve``: a force-displacement curve, or a surface at pull-off, by one model or several."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd
from matplotlib.figure import Figure

from comparisons.cli.options import FAILED, MODEL_SPEC, OK, add_case, case_of, number
from comparisons.console.progress import log, waiting
from comparisons.curve_quantities import SHAPES, traced
from comparisons.model import ComputationFailed, Model, NotApplicable
from comparisons.output.figures import force_curve, profiles
from comparisons.output.style import picture_path, save
from comparisons.registry import create, identify
from comparisons.runs.atomic_files import atomic, writable_file
from comparisons.runs.cases import Case
from comparisons.runs.csv_format import csv_text
from fscm.problem import Problem

__all__ = ["add", "call"]

_Found = TypeVar("_Found")


def add(parsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the arguments."""
    parser = parsers.add_parser("curve", help="force-displacement curves as CSV and as a plot", description=__doc__)
    parser.add_argument(
        "--model",
        metavar="SPEC",
        nargs="+",
        action="extend",
        required=True,
        help=MODEL_SPEC,
    )
    parser.add_argument("--quantity", choices=SHAPES, default="force_curve", help="what to draw (default: force_curve)")
    add_case(parser)
    parser.add_argument("--nu", type=number, help="Poisson's ratio, 0 <= nu < 0.5, for the models that need one")
    parser.add_argument("--csv", metavar="FILE", type=Path, help="write the points here; by default to stdout")
    parser.add_argument("--plot", metavar="FILE", type=Path, help="draw the curves here (.png, .pdf or .svg)")
    parser.set_defaults(call=call)


def call(args: argparse.Namespace) -> int:
    """Trace, write, draw; return the exit status."""
    case = case_of(args)
    # All that can be wrong with the request is found out before anything is computed.
    names, external = identify(args.model)
    models = {name: create(external[name].spec if name in external else name, case.nu) for name in names}
    if args.csv:
        writable_file(args.csv)
    if args.plot:
        writable_file(picture_path(args.plot))
    points, draw, status = _traced(models, args.quantity, case)
    if args.csv:
        with atomic(args.csv) as file:
            file.write(csv_text(points).encode())
    if args.plot:
        save(draw(), args.plot)
    if not args.csv and not args.plot:
        print(csv_text(points), end="")
    return status


def _traced(models: dict[str, Model], quantity: str, case: Case) -> tuple[pd.DataFrame, Callable[[], Figure], int]:
    """Evaluate every model; return one row a point, a function that draws them, and the exit status."""
    if quantity == "force_curve":
        # Not through the registry of shapes, which has no room for the other columns of a path.
        curves, status = _evaluated(models, case, traced)
        tables = {
            name: {"displacement": curve.displacement, "load": curve.load, **curve.columns}
            for name, curve in curves.items()
        }
        axes = ["displacement", "load"]
        return _points(tables, axes), lambda: force_curve.draw(curves, case.label), status
    shape = SHAPES[quantity]
    found, status = _evaluated(models, case, shape.ask)
    surfaces = {name: {shape.x: points.x, shape.y: points.y} for name, points in found.items()}
    return _points(surfaces, [shape.x, shape.y]), lambda: profiles.draw(found, quantity, case.label), status


def _evaluated(
    models: dict[str, Model], case: Case, evaluate: Callable[[Model, Problem], _Found]
) -> tuple[dict[str, _Found], int]:
    """Return the results by model, and the exit status; the models without a result are named on stderr."""
    found: dict[str, _Found] = {}
    status = OK
    for name, model in models.items():
        try:
            with waiting(f"{name}, {case.label}"):
                found[name] = evaluate(model, case.problem())
        except NotApplicable as refusal:
            log(f"{name}: not-applicable: {refusal}")
        except ComputationFailed as failure:
            log(f"{name}: failed: {failure}")
            status = FAILED
    return found, status


def _points(tables: Mapping[str, Mapping[str, Any]], axes: list[str]) -> pd.DataFrame:
    """One row a point, in the order of each path; a column that a model does not know is empty."""
    frames = [pd.DataFrame({"model": name, **table}) for name, table in tables.items()]
    return pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=["model", *axes])
