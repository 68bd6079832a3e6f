"""``fscm-bench fem``: fields, a picture, verification and the linear solver of the finite elements."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from typing import TYPE_CHECKING

import lazy_loader

import fem_reference
from comparisons.cli.options import CASE, NUMBER, command, file, option, problem_of
from comparisons.cli.screen import output
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log, waiting
from comparisons.model import NotApplicable
from comparisons.models.fem_model import FiniteElements
from comparisons.output.style import picture_path, save
from comparisons.output.terminal import rich_table
from comparisons.runs.atomic_files import writable_file, writing
from fem_reference import export
from fem_reference.verification import FULL_STUDY, QUICK_STUDY, elastic_checks, solver_table

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")

_EVENT = f"the event whose state is shown: {', '.join(fem_reference.EVENTS)} (default: %(default)s)"


_FORMATS = {"error": ".1e", "limit": ".2g", "residual": ".0e", "agreement": ".0e"} | {
    **dict.fromkeys(("setup_seconds", "solve_seconds", "direct_seconds"), ".2f"),
    **dict.fromkeys(("megabytes", "direct_megabytes"), ".0f"),
}
#: The picture extends to so many contact radii, and its largest displacement is this share of that.
_EXTENT, _SHARE = 2.0, 0.15


@command(
    *CASE,
    option("--nu", type=NUMBER, default=0.3, help="Poisson's ratio, in [0, 0.5) (default: %(default)s)"),
    option("--event", default="pull_off", metavar="EVENT", choices=fem_reference.EVENTS, help=_EVENT),
    file("--vtu", help="write mesh, displacement and stresses to this file"),
    file("--plot", help="draw the deformed body into this file"),
    option("--verify", action="store_true", help="print the checks against exact solutions"),
    option("--solver", action="store_true", help="print the study of the linear solvers"),
    option("--full", action="store_true", help="all checks and sizes (long)"),
)
def fem_command(args: argparse.Namespace) -> int:
    """Compute, write and print; return the exit status.

    For example::

        fscm-bench fem --n 2 --k 0.4 --mu 1 --vtu body.vtu --plot body.png
        fscm-bench fem --verify
    """
    if not (args.vtu or args.plot or args.verify or args.solver):
        raise ValueError("nothing to do: give --vtu FILE, --plot FILE, --verify or --solver")
    status = _fields(args) if args.vtu or args.plot else OK
    if args.verify:
        with waiting("verification"):
            checks = elastic_checks(args.full)
        rows = pd.DataFrame(asdict(check) | {"passed": check.passed} for check in checks)
        output().print(rich_table(rows, "verification of the finite elements", _FORMATS))
        if not rows["passed"].all():
            status = FAILED
    if args.solver:
        with waiting("linear solvers"):
            rows = pd.DataFrame(map(asdict, solver_table(FULL_STUDY if args.full else QUICK_STUDY)))
        output().print(rich_table(rows, "conjugate gradients with pyamg beside a direct solve", _FORMATS))
    return status


def _fields(args: argparse.Namespace) -> int:
    """Write the state of an event as vtu and picture."""
    case = problem_of(args)
    if args.vtu:
        if args.vtu.suffix != ".vtu":
            raise ValueError(f"--vtu {args.vtu} does not end in .vtu, by which ParaView recognises the format")
        writable_file(args.vtu)
    if args.plot:
        writable_file(picture_path(args.plot))
    try:
        with waiting(f"fem, {case.label}"):
            field, radius = FiniteElements(args.nu).field(case, args.event)
    except NotApplicable as refusal:
        log(f"not-applicable: {refusal}")
        return OK
    punch = f"a punch with Q = {FiniteElements.shape_parameter(case.n):.4g} z0^(n-1)"
    if args.vtu:
        with writing(args.vtu):
            export.write_vtu(field, args.vtu)
        log(f"{args.vtu}: lengths in z0, stresses in dgamma/z0, for {punch}")
    if args.plot:
        extent = _EXTENT * radius
        inside = (field.points < extent).all(axis=1)
        # One digit, since the figure states it.
        magnification = float(f"{_SHARE * extent / float(abs(field.displacement[inside]).max()):.1g}")
        figure = export.draw(field, extent, magnification)
        section, scale = figure.axes[:2]
        section.set_xlabel(f"radius / z0, {punch}")
        section.set_ylabel(f"depth / z0, displacement and gap magnified {magnification:g} times")
        section.set_title(f"{args.event.replace('_', '-')} at {case.label}")
        scale.set_ylabel("axial stress z0 / dgamma, tension positive")
        save(figure, args.plot)
    return OK
