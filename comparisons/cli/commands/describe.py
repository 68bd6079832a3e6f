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
    from comparisons.problem_file.overview import overview_of
    from comparisons.problem_file.overview_text import content, lines
    from comparisons.problem_file.reading import load_problem

    problem = load_problem(args.file)
    with waiting(problem.label):
        overview = overview_of(problem)
    if args.format == "json":
        print(json.dumps(content(overview), allow_nan=False))
    else:
        print("\n".join(lines(overview)))
    return FAILED if overview.force.status == "failed" else OK
