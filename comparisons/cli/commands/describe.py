"""``fscm-bench describe``: what a problem file states, and which models may be used for it."""

from __future__ import annotations

import argparse
import json

from comparisons.cli.options import command, file, option, output_format
from comparisons.cli.screen import print_text
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import waiting
from comparisons.description.assumptions import assumptions
from comparisons.description.equivalent_power_law import equivalent_power_law
from comparisons.description.forces import profile_sensitivity, reference_force
from comparisons.description.overview import overview
from comparisons.description.text import description_text
from comparisons.description.uncertainty import check_quantity, check_uncertain, uncertainty
from comparisons.problem import Problem

_UNCERTAIN = "also print the uncertainty of the pull-off force from the uncertain values of the file"


@command(
    file("file", nargs="?", help="a problem file, see docs/problem_files.md"),
    file("--problem", help="the same, as the other commands take it"),
    option("--uncertain", action="store_true", help=_UNCERTAIN),
    option(
        "--large-strain",
        action="store_true",
        help="solve the problem with finite strain, for the error of the small-strain assumption; takes up to a minute",
    ),
    option("--quantity", metavar="NAME", help="another quantity than the pull-off force, with --uncertain"),
    output_format("json"),
)
def describe_command(args: argparse.Namespace) -> int:
    """Compute and print; return the exit status.

    For example::

        fscm-bench describe pad.toml
        fscm-bench describe pad.toml --uncertain
    """
    if args.quantity is not None and not args.uncertain:
        raise ValueError("--quantity is that of --uncertain; give both, or take solve for the value")
    if args.quantity is not None:
        check_quantity(args.quantity)
    if (args.file is None) == (args.problem is None):
        raise ValueError("describe takes one problem file: fscm-bench describe FILE")
    problem = Problem.load(args.file or args.problem)
    if args.uncertain:
        check_uncertain(problem)
    with waiting(f"solving {problem.label} with fscm", is_long=True):
        of_values = uncertainty(problem, args.quantity or "pull_off_force") if args.uncertain else None
        force = reference_force(problem)
        equivalent = equivalent_power_law(problem, force)
        described = overview(problem, force, assumptions(problem, force, args.large_strain), equivalent)
        changes = profile_sensitivity(problem, force)
    if args.format == "json":
        parts = {"equivalent_power_law": equivalent, "profile_sensitivity": changes, "uncertainty": of_values}
        print(json.dumps(described | {name: content for name, content in parts.items() if content}, allow_nan=False))
    else:
        print_text(description_text(problem, described, equivalent, changes, of_values).splitlines())
    failed = force.status == "failed" or (of_values is not None and of_values["status"] == "failed")
    return FAILED if failed else OK
