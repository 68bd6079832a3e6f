"""``fscm-bench describe``: what a problem file states, and which models may be used for it."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from comparisons.cli.options import FAILED, OK
from comparisons.console.progress import waiting

__all__ = ["EXAMPLES", "add", "call"]

#: Examples of the help.
EXAMPLES = ("fscm-bench describe pad.toml",)


def add(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("file", metavar="FILE", type=Path, help="a problem file, see docs/problem_files.md")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="(default: %(default)s)")


def call(args: argparse.Namespace) -> int:
    """Compute and print; return the exit status."""
    # Imported here: the help does not need them.
    from comparisons.problem_file import equivalent_text, profile_sensitivity
    from comparisons.problem_file.equivalent_power_law import equivalent_power_law
    from comparisons.problem_file.overview import overview_of
    from comparisons.problem_file.overview_text import content, lines
    from comparisons.problem_file.reading import load_problem

    problem = load_problem(args.file)
    with waiting(problem.label):
        overview = overview_of(problem)
        equivalent = equivalent_power_law(problem, overview.force)
        changes = profile_sensitivity.profile_sensitivity(problem, overview.force)
    if args.format == "json":
        found = content(overview)
        if equivalent is not None:
            found["equivalent_power_law"] = equivalent_text.content(equivalent)
        if changes:
            found["profile_sensitivity"] = profile_sensitivity.content(changes)
        print(json.dumps(found, allow_nan=False))
    else:
        text = lines(overview)
        if equivalent is not None:
            text += equivalent_text.lines(equivalent)
        if changes:
            text += profile_sensitivity.lines(changes)
        print("\n".join(text))
    return FAILED if overview.force.status == "failed" else OK
