"""``fscm-bench describe``: what a problem file states, and which models may be used for it."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli.options import FAILED, OK, for_terminal
from comparisons.console.progress import waiting

if TYPE_CHECKING:
    from comparisons.problem_file.description import ProblemFile
    from comparisons.problem_file.propagation_text import Outcome

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench describe pad.toml", "fscm-bench describe pad.toml --uncertain")


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("file", metavar="FILE", type=Path, help="a problem file, see docs/problem_files.md")
    parser.add_argument(
        "--uncertain",
        action="store_true",
        help="what the standard deviations and intervals of the file mean for the pull-off force",
    )
    parser.add_argument("--quantity", metavar="NAME", help="another value at an event, with --uncertain")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="(default: %(default)s)")


def call(args: argparse.Namespace) -> int:
    """Compute and print; return the exit status."""
    # Imported here: the help does not need them.
    from comparisons.problem_file import equivalent_text, profile_sensitivity
    from comparisons.problem_file.equivalent_power_law import equivalent_power_law
    from comparisons.problem_file.overview import overview_of
    from comparisons.problem_file.overview_text import content, lines
    from comparisons.problem_file.reading import load_problem

    if args.quantity is not None and not args.uncertain:
        raise ValueError("--quantity is that of --uncertain; give both, or take solve for the value")
    problem = load_problem(args.file)
    with waiting(problem.label):
        # First: it may refuse the file or the quantity.
        uncertain = _uncertain(problem, args.quantity or "pull_off_force") if args.uncertain else None
        overview = overview_of(problem)
        equivalent = equivalent_power_law(problem, overview.force)
        changes = profile_sensitivity.profile_sensitivity(problem, overview.force)
    if args.format == "json":
        found = content(overview)
        if equivalent is not None:
            found["equivalent_power_law"] = equivalent_text.content(equivalent)
        if changes:
            found["profile_sensitivity"] = profile_sensitivity.content(changes)
        if uncertain is not None:
            found["uncertainty"] = uncertain.content
        print(json.dumps(found, allow_nan=False))
    else:
        text = lines(overview, equivalent)
        if equivalent is not None:
            text += equivalent_text.lines(equivalent)
        if changes:
            text += profile_sensitivity.lines(changes)
        if uncertain is not None:
            text += uncertain.lines
        print(for_terminal(text), end="")
    return FAILED if overview.force.status == "failed" or (uncertain is not None and uncertain.failed) else OK


def _uncertain(problem: ProblemFile, quantity: str) -> Outcome:
    from comparisons.problem_file.propagation_text import outcome_of

    return outcome_of(problem, quantity)
