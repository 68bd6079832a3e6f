"""``fscm-bench describe``: what a problem file states, and which models may be used for it."""

from __future__ import annotations

import argparse
import json

from comparisons.cli.options import file, option
from comparisons.cli.screen import print_lines
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import waiting
from comparisons.description import equivalent_text, profile_sensitivity
from comparisons.description.equivalent_power_law import equivalent_power_law
from comparisons.description.overview import overview_of
from comparisons.description.overview_text import content, lines
from comparisons.description.propagation_text import outcome_of
from comparisons.problem import Problem

__all__ = ["call"]

EXAMPLES = ("fscm-bench describe pad.toml", "fscm-bench describe pad.toml --uncertain")

OPTIONS = (
    file("file", help="a problem file, see docs/problem_files.md"),
    option(
        "--uncertain",
        action="store_true",
        help="what the standard deviations and intervals of the file mean for the pull-off force",
    ),
    option("--quantity", metavar="NAME", help="another value at an event, with --uncertain"),
    option("--format", choices=("text", "json"), default="text", help="(default: %(default)s)"),
)


def call(args: argparse.Namespace) -> int:
    """Compute and print; return the exit status."""
    if args.quantity is not None and not args.uncertain:
        raise ValueError("--quantity is that of --uncertain; give both, or take solve for the value")
    problem = Problem.load(args.file)
    with waiting(problem.label):
        # First: it may refuse the file or the quantity.
        uncertain = outcome_of(problem, args.quantity or "pull_off_force") if args.uncertain else None
        overview = overview_of(problem)
        equivalent = equivalent_power_law(problem, overview.force)
        changes = profile_sensitivity.profile_sensitivity(problem, overview.force)
    if args.format == "json":
        described = content(overview)
        if equivalent is not None:
            described["equivalent_power_law"] = equivalent_text.content(equivalent)
        if changes:
            described["profile_sensitivity"] = profile_sensitivity.content(changes)
        if uncertain is not None:
            described["uncertainty"] = uncertain.content
        print(json.dumps(described, allow_nan=False))
    else:
        text = lines(overview, equivalent)
        if equivalent is not None:
            text += equivalent_text.lines(equivalent)
        if changes:
            text += profile_sensitivity.lines(changes)
        if uncertain is not None:
            text += uncertain.lines
        print_lines(text)
    return FAILED if overview.force.status == "failed" or (uncertain is not None and uncertain.failed) else OK
