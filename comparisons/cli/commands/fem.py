"""``fscm-bench fem``: fields, a picture, verification and the linear solver of the finite elements."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

import pandas as pd

import fem_reference
from comparisons.cli.options import FAILED, OK, add_case, case_of, number, output
from comparisons.console.progress import log, waiting
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.models.fem_model import FiniteElements
from comparisons.output.style import picture_path, save
from comparisons.output.terminal import rich_table
from comparisons.runs.atomic_files import writable_file, writing
from fem_reference import export
from fem_reference.verification import FULL_STUDY, QUICK_STUDY, elastic_checks, solver_table

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = (
    "fscm-bench fem --n 2 --k 0.4 --mu 1 --vtu body.vtu --plot body.png",
    "fscm-bench fem --verify",
)

_ERRORS = {"error": ".1e", "limit": ".2g"}
_STUDY = {"residual": ".0e", "setup_seconds": ".2f", "solve_seconds": ".2f", "megabytes": ".0f"} | {
    "direct_seconds": ".2f",
    "direct_megabytes": ".0f",
    "agreement": ".0e",
}
# The picture shows this many contact radii, and its largest displacement as this share of them.
_SHOWN, _SHARE = 2.0, 0.15


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_case(parser, required=False)
    parser.add_argument("--nu", type=number, default=0.3, help="Poisson's ratio, in [0, 0.5) (default: %(default)s)")
    parser.add_argument(
        "--event",
        default="pull_off",
        metavar="EVENT",
        choices=fem_reference.EVENTS,
        help=f"the event whose state is shown: {', '.join(fem_reference.EVENTS)} (default: %(default)s)",
    )
    parser.add_argument("--vtu", metavar="FILE", type=Path, help="write mesh, displacement and stresses here")
    parser.add_argument("--plot", metavar="FILE", type=Path, help="draw the deformed body here")
    parser.add_argument("--verify", action="store_true", help="print the checks against exact solutions")
    parser.add_argument("--solver", action="store_true", help="print the table of the linear solvers")
    parser.add_argument("--full", action="store_true", help="all checks and sizes (long)")


def call(args: argparse.Namespace) -> int:
    """Compute, write and print; return the exit status."""
    if not (args.vtu or args.plot or args.verify or args.solver):
        raise ValueError("nothing to do: give --vtu FILE, --plot FILE, --verify or --solver")
    status = _fields(args) if args.vtu or args.plot else OK
    if args.verify:
        with waiting("verification"):
            checks = elastic_checks(args.full)
        rows = [asdict(check) | {"passed": check.passed} for check in checks]
        output().print(rich_table(pd.DataFrame(rows), "verification of the finite elements", _ERRORS))
        if not all(check.passed for check in checks):
            status = FAILED
    if args.solver:
        with waiting("linear solvers"):
            table = solver_table(FULL_STUDY if args.full else QUICK_STUDY)
        rows = [asdict(row) for row in table]
        output().print(rich_table(pd.DataFrame(rows), "conjugate gradients with pyamg beside a direct solve", _STUDY))
    return status


def _fields(args: argparse.Namespace) -> int:
    """Write the state of an event as vtu and picture."""
    missing = [f"--{name}" for name in ("n", "k", "mu") if getattr(args, name) is None]
    if missing:
        raise ValueError(f"--vtu and --plot need a case; give {', '.join(missing)} too")
    case = case_of(args)
    if args.vtu:
        if args.vtu.suffix != ".vtu":
            raise ValueError(f"--vtu {args.vtu} does not end in .vtu, by which ParaView recognises the format")
        writable_file(args.vtu)
    if args.plot:
        writable_file(picture_path(args.plot))
    try:
        with waiting(f"fem, {case.label}"):
            field, radius = FiniteElements(args.nu).field(case.problem(), args.event)
    except NotApplicable as refusal:
        log(f"not-applicable: {refusal}")
        return OK
    except ComputationFailed as failure:
        log(f"failed: {failure}")
        return FAILED
    size = FiniteElements.shape_parameter(case.n)
    if args.vtu:
        with writing(args.vtu):
            export.write_vtu(field, args.vtu)
        log(f"{args.vtu}: lengths in z0, stresses in dgamma/z0, for a punch with Q = {size:.4g} z0^(n-1)")
    if args.plot:
        shown = _SHOWN * radius
        inside = (field.points < shown).all(axis=1)
        largest = float(abs(field.displacement[inside]).max())
        # One digit, since the figure states it.
        magnification = float(f"{_SHARE * shown / largest:.1g}")
        figure = export.draw(field, shown, magnification)
        axes = figure.axes[0]
        axes.set_xlabel(f"radius $r / z_0$ of a punch with $Q$ = {size:.4g} $z_0^{{n-1}}$")
        axes.set_ylabel(f"depth $z / z_0$, displacement and gap magnified {magnification:g} times")
        event = args.event.replace("_", "-")
        axes.set_title(rf"{event} at $n$ = {case.n:g}, $k$ = {case.k:g}, $\mu$ = {case.mu:g}, $\nu$ = {args.nu:g}")
        figure.axes[1].set_ylabel(r"axial stress $\sigma_{zz} z_0 / \Delta\gamma$, tension positive")
        save(figure, args.plot)
    return OK
