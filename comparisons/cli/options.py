"""Parts that several commands share: exit statuses, the arguments of a case, the output console."""

from __future__ import annotations

import argparse
import sys
from typing import Any, NoReturn

from rich.console import Console

from comparisons.console.exit_status import FAILED, FAILS, INCONCLUSIVE, OK, WRONG_INPUT, writing_stdout
from comparisons.runs.cases import Case

__all__ = [
    "FAILED",
    "FAILS",
    "INCONCLUSIVE",
    "MODEL_SPEC",
    "OK",
    "WRONG_INPUT",
    "add_case",
    "case_of",
    "number",
    "output",
]

#: What a SPEC is, where one is asked for.
MODEL_SPEC = "a name (fscm-bench list models), FILE.py:CLASS, or a folder with a model.toml"

#: Columns of a table when stdout is no terminal, where rich would assume 80 and break the lines.
_WIDTH = 160


class _Output(Console):
    def print(self, *objects: Any, **options: Any) -> None:
        with writing_stdout():
            super().print(*objects, **options)

    def on_broken_pipe(self) -> NoReturn:
        raise BrokenPipeError


def output() -> Console:
    """Return the console for results, which is stdout."""
    return _Output(width=None if sys.stdout.isatty() else _WIDTH, highlight=False)


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


def case_of(args: argparse.Namespace) -> Case:
    """Return the case the arguments describe; `ValueError` if it is inadmissible."""
    return Case(args.n, args.k, args.mu, getattr(args, "nu", None))
