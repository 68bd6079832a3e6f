"""Output of the commands for a problem file: a value as text, JSON or CSV, and curves in SI units."""

from __future__ import annotations

import argparse
import csv
import dataclasses
import io
import json

import pandas as pd

from comparisons.cli.screen import print_lines
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import waiting
from comparisons.model import Model
from comparisons.problem_file.description import ProblemFile
from comparisons.problem_file.evaluation import PhysicalValue, evaluate_problem, model_for, points_of, units_of
from comparisons.problem_file.reading import load_problem
from comparisons.problem_file.units import si_text
from comparisons.quantities import CURVES, QUANTITIES, CurveQuantity, Points

__all__ = ["InSI", "problem_of", "quantity_in_si", "solve_file"]

#: Symbols of the axes as mathematics of Matplotlib.
_SYMBOLS = {"displacement": r"\delta", "load": "P", "radius": "r", "pressure": "p", "gap": "H"}


def problem_of(args: argparse.Namespace) -> ProblemFile:
    """Read the problem file of the arguments, which then have no parameters of a dimensionless problem.

    Raises
    ------
    ValueError
        If they have, or as `load_problem`.
    """
    twice = [f"--{name}" for name in ("n", "k", "mu", "nu") if getattr(args, name) is not None]
    if twice:
        raise ValueError(f"{', '.join(twice)} and --problem exclude each other: the file states the whole problem")
    return load_problem(args.problem)


def solve_file(args: argparse.Namespace) -> int:
    """Compute one quantity of the problem of a file and print it; return the exit status."""
    problem = problem_of(args)
    model = model_for(problem, args.model)
    with waiting(f"{args.model}, {problem.label}"):
        found = evaluate_problem(problem, model, args.quantity)
    if args.format == "text":
        print_lines(_lines(found))
    else:
        print({"json": _json, "csv": _csv}[args.format](found), end="")
    return FAILED if found.status == "failed" else OK


def _json(found: PhysicalValue) -> str:
    content = {
        "model": found.model,
        "quantity": found.quantity,
        "problem": found.problem,
        "value": found.value,
        "u_num": found.u_num,
        "status": found.status,
        "unit": found.unit,
        "seconds": found.seconds,
    }
    if found.dimensionless:
        content["dimensionless"] = found.dimensionless
    if found.reason:
        content["reason"] = found.reason
    return json.dumps(content, allow_nan=False) + "\n"


def _csv(found: PhysicalValue) -> str:
    row = {**dataclasses.asdict(found), "problem": found.problem["file"]}
    scaled = row.pop("dimensionless") or {}
    row |= {f"dimensionless_{name}": scaled.get(name, "") for name in ("value", "u_num", "unit")}
    text = io.StringIO()
    writer = csv.DictWriter(text, list(row), lineterminator="\n")
    writer.writeheader()
    writer.writerow({name: "" if cell is None else cell for name, cell in row.items()})
    return text.getvalue()


def _lines(found: PhysicalValue) -> list[str]:
    quantity = QUANTITIES[found.quantity]
    lines = [f"{found.model}: {found.quantity} of {found.problem['file']}"]
    if found.value is None or found.u_num is None:
        lines.append(f"  {found.status}: {found.reason}")
    else:
        lines.append(f"  {quantity.symbol} = {si_text(found.value, found.u_num, found.unit)}  ({found.seconds:.2g} s)")
    if found.dimensionless:
        scaled = found.dimensionless
        number = si_text(float(scaled["value"]), float(scaled["u_num"]), "1")
        lines.append(f"  dimensionless: {number} {scaled['unit']}")
    if found.value is not None and found.reason:
        lines.append(f"  {found.reason}")
    return lines


class InSI:
    """A curve of the problem of a file, for the command that draws it.

    Attributes
    ----------
    nu : float or None
        Poisson's ratio, for models that need one.
    label : str
    axes : CurveQuantity
        With labels in SI.
    """

    def __init__(self, problem: ProblemFile, quantity: str) -> None:
        self._problem, self._quantity = problem, quantity
        self.nu: float | None = problem.solid.get("nu") if problem.is_of_the_paper else None
        self.label = problem.label
        self.axes = quantity_in_si(quantity)

    def points(self, model: Model) -> Points:
        """Return the points of a model in SI, or raise `NotApplicable` or `ComputationFailed`."""
        return points_of(self._problem, model, self._quantity)

    def table(self, table: pd.DataFrame) -> pd.DataFrame:
        """Return a table of points whose columns have their units in their names: ``displacement [m]``."""
        x, y = units_of(self._quantity)
        units = {self.axes.x.name: x, self.axes.y.name: y}
        units |= {name: "m" for name in table.columns if name.endswith(("_gap", "_radius"))}
        return table.rename(columns={name: f"{name} [{unit}]" for name, unit in units.items()})


def quantity_in_si(quantity: str) -> CurveQuantity:
    r"""Return a curve whose axes are labelled in SI.

    Examples
    --------
    >>> quantity_in_si("force_curve").x.figure_label
    'displacement $\\delta\\ \\mathrm{(m)}$'
    """
    row = CURVES[quantity]
    x, y = (
        dataclasses.replace(axis, mathtext=rf"{_SYMBOLS[axis.name]}\ \mathrm{{({unit})}}", unit=unit)
        for axis, unit in zip((row.x, row.y), units_of(quantity), strict=True)
    )
    return dataclasses.replace(row, x=x, y=y)
