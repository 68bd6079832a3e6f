"""Parts that several commands share: exit statuses, arguments, the output console."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from comparisons.console.exit_status import FAILED, FAILS, INCONCLUSIVE, OK, WRONG_INPUT, writing_stdout
from comparisons.console.folding import hanging
from comparisons.console.printable import printable
from comparisons.console.safe_console import SafeConsole
from comparisons.runs.cases import Case
from comparisons.runs.workers import usable_cores

__all__ = [
    "FAILED",
    "FAILS",
    "INCONCLUSIVE",
    "MODEL_SPEC",
    "OK",
    "WRONG_INPUT",
    "add_case",
    "add_case_or_file",
    "add_jobs",
    "add_out",
    "add_quiet",
    "add_retry_failed",
    "add_verbose",
    "case_of",
    "for_terminal",
    "number",
    "output",
]

#: Help for a SPEC.
MODEL_SPEC = "a name (fscm-bench list models), FILE.py:CLASS, ./PROGRAM, or a folder with a model.toml"

#: Columns of a table when stdout is no terminal: the same text in every log and file.
_WIDTH = 80


class _Output(SafeConsole):
    def print(self, *objects: Any, **options: Any) -> None:
        # A word that is longer than a line, as a path, goes on in the next one; rich would cut it.
        with writing_stdout():
            super().print(*objects, **{"crop": False, **options})


def output() -> SafeConsole:
    """Return the console for results: stdout with the columns of the terminal, or 80 where it is none."""
    return _Output(width=None if sys.stdout.isatty() else _WIDTH, highlight=False, markup=False)


def for_terminal(lines: Iterable[str]) -> str:
    """Return lines as a text; on a terminal they are folded between words, in a file they are whole."""
    if sys.stdout.isatty():
        width = output().width
        lines = [part for line in lines for part in hanging(line, width)]
    return printable("\n".join(lines)) + "\n"


def number(text: str) -> float:
    """Read a real number.

    Raises
    ------
    argparse.ArgumentTypeError
        If the text is not one.
    """
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None


def add_case(parser: argparse.ArgumentParser, required: bool = True) -> None:
    """Declare the parameters of one problem."""
    for name, meaning in (
        ("--n", "shape index of the punch r^n/n, 2/3 < n <= 300 (1 cone, 2 paraboloid)"),
        ("--k", "gradient exponent of E = E0 (z/c0)^k, 0 to 1 (finite elements: to 0.9)"),
        ("--mu", "generalised Tabor number (Eq. 29), > 0"),
    ):
        parser.add_argument(name, type=number, required=required, help=meaning)


def add_case_or_file(parser: argparse.ArgumentParser) -> None:
    """Declare the parameters of one problem, and the file that takes their place."""
    add_case(parser, required=False)
    parser.add_argument("--nu", type=number, help="Poisson's ratio, 0 <= nu < 0.5, for the models that need one")
    parser.add_argument(
        "--problem", metavar="FILE", type=Path, help="in place of these: a file in physical units; results are in SI"
    )


def add_jobs(parser: argparse.ArgumentParser) -> None:
    """Declare the number of processes."""
    parser.add_argument("--jobs", metavar="N", type=int, default=usable_cores(), help="processes (default: one a core)")


def add_out(parser: argparse.ArgumentParser) -> None:
    """Declare the folder for the results."""
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help="folder for the results (default: results/runs/TIME); resumed if it has some",
    )


def add_quiet(parser: argparse.ArgumentParser) -> None:
    """Declare the option that leaves out all but failures."""
    parser.add_argument("--quiet", action="store_true", help="print nothing but warnings and failures")


def add_verbose(parser: argparse.ArgumentParser) -> None:
    """Declare the option that prints all rows."""
    parser.add_argument("--verbose", action="store_true", help="print every row, not a summary")


def add_retry_failed(parser: argparse.ArgumentParser) -> None:
    """Declare the option that computes stored failures again."""
    parser.add_argument(
        "--retry-failed",
        action="store_true",
        help="compute stored failures again (those of external models always are)",
    )


def case_of(args: argparse.Namespace) -> Case:
    """Return the case the arguments describe; `ValueError` if it is inadmissible or not complete."""
    missing = [f"--{name}" for name in ("n", "k", "mu") if getattr(args, name) is None]
    if missing and "problem" in args:
        raise ValueError(
            f"the following arguments are required: {', '.join(missing)}; or give a file with --problem FILE"
        )
    return Case(args.n, args.k, args.mu, getattr(args, "nu", None))
