"""``fscm-bench curve``: the force-displacement curve of one problem by one model or several."""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd

from comparisons.commands.options import FAILED, OK, add_case, case_of
from comparisons.figures import force_curve
from comparisons.figures.style import picture_path, save
from comparisons.model import ComputationFailed, Curve, NotApplicable, TracesCurve
from comparisons.models import create, identify
from comparisons.progress import log, waiting
from comparisons.store import atomic, csv_text, writable_file

__all__ = ["add", "call"]


def add(parsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the arguments."""
    parser = parsers.add_parser("curve", help="force-displacement curves as CSV and as a plot", description=__doc__)
    parser.add_argument(
        "--model",
        metavar="NAME",
        nargs="+",
        action="extend",
        required=True,
        help="see: fscm-bench list models",
    )
    add_case(parser)
    parser.add_argument("--csv", metavar="FILE", type=Path, help="write the points here; by default to stdout")
    parser.add_argument("--plot", metavar="FILE", type=Path, help="draw the curves here (.png, .pdf or .svg)")
    parser.set_defaults(call=call)


def call(args: argparse.Namespace) -> int:
    """Trace, write, draw; return the exit status."""
    case = case_of(args)
    # All that can be wrong with the request is found out before anything is computed.
    names, outside = identify(args.model)
    models = {name: create(outside[name].spec if name in outside else name) for name in names}
    if args.csv:
        writable_file(args.csv)
    if args.plot:
        writable_file(picture_path(args.plot))
    curves: dict[str, Curve] = {}
    status = OK
    for name, model in models.items():
        try:
            if not isinstance(model, TracesCurve):
                raise NotApplicable("the model has no force-displacement curve")
            with waiting(f"{name}, {case.label}"):
                curves[name] = model.curve(case.problem())
        except NotApplicable as refusal:
            log(f"{name}: not-applicable: {refusal}")
        except ComputationFailed as failure:
            log(f"{name}: failed: {failure}")
            status = FAILED
    points = _points(curves)
    if args.csv:
        with atomic(args.csv) as file:
            file.write(csv_text(points).encode())
    if args.plot:
        save(force_curve.draw(curves, case.label), args.plot)
    if not args.csv and not args.plot:
        print(csv_text(points), end="")
    return status


def _points(curves: dict[str, Curve]) -> pd.DataFrame:
    """One row a point, in the order of each path; a column that a model does not know is empty."""
    tables = [
        pd.DataFrame({"model": name, "displacement": curve.displacement, "load": curve.load, **curve.columns})
        for name, curve in curves.items()
    ]
    return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame(columns=["model", "displacement", "load"])
