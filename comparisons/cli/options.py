"""Commands and their options: how they are declared, and the options that several commands share."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from comparisons.data.plain_numbers import plain_float, plain_int
from comparisons.runs.cores import usable_cores

if TYPE_CHECKING:
    from comparisons.problem import Problem

#: An option of a command: names and settings as of `argparse.ArgumentParser.add_argument`.
Option = tuple[tuple[str, ...], dict[str, Any]]


class Command(NamedTuple):
    """A command: its options, and the function that returns the exit status, with examples in its text."""

    call: Callable[[argparse.Namespace], int]
    options: tuple[Option, ...]


def command(*options: Option) -> Callable[[Callable[[argparse.Namespace], int]], Command]:
    """Declare a command with its options."""
    return lambda call: Command(call, options)


def option(*names: str, **settings: Any) -> Option:
    """Declare an option."""
    return names, settings


def file(*names: str, metavar: str = "FILE", **settings: Any) -> Option:
    """Declare an option that is a path."""
    return names, {"metavar": metavar, "type": Path, **settings}


def several(*names: str, metavar: str, **settings: Any) -> Option:
    """Declare an option with one value or more, which may be repeated."""
    return names, {"metavar": metavar, "nargs": "+", "action": "extend", **settings}


class _Joined(argparse.Action):
    """An option whose words are lists of numbers, which are put together."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, *_: Any) -> None:
        setattr(namespace, self.dest, list(chain.from_iterable(values)))


def numbers(*names: str, logarithmic: bool = False, **settings: Any) -> Option:
    """Declare an option with numbers or ranges FROM:TO:COUNT, at equal distances or at equal ratios."""
    read = partial(_numbers, logarithmic=logarithmic)
    return names, {"metavar": "X", "type": read, "nargs": "+", "action": _Joined, **settings}


def _numbers(text: str, logarithmic: bool) -> list[float]:
    """Return the numbers that a word of an option means."""
    # Imported here, as in `problem_of`: a command without a problem needs no solver.
    from comparisons.problem.variation import RANGE, spaced

    words = RANGE.fullmatch(text)
    try:
        texts = spaced(words[1], words[2], words[3], logarithmic) if words and not words[4] else [text]
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text}: {error}") from None
    try:
        return [plain_float(number) for number in texts]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is neither a number nor a range FROM:TO:COUNT") from None


def _argument(read: Callable[[str], Any]) -> Callable[[str], Any]:
    """Return a reader whose sentence argparse shows."""

    def argument(text: str) -> Any:
        try:
            return read(text)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return argument


#: Types of options.
NUMBER, INTEGER = _argument(plain_float), _argument(plain_int)


def output_format(*names: str, help: str = "(default: text)") -> Option:
    """Declare the option --format with text and other forms."""
    return option("--format", choices=("text", *names), default="text", help=help)


#: Help for a SPEC.
MODEL_SPEC = "a name (fscm-bench list models), FILE.py:CLASS, ./PROGRAM, or a folder with a model.toml"

#: The parameters of one problem.
CASE = (
    option("--n", type=NUMBER, help="shape index of the punch r^n/n, 2/3 < n <= 300 (1 cone, 2 paraboloid)"),
    option("--k", type=NUMBER, help="gradient exponent of E = E0 (z/c0)^k, 0 to 1 (finite elements: to 0.9)"),
    option("--mu", type=NUMBER, help="generalised Tabor number (Eq. 29), > 0"),
)

#: The parameters of one problem, and the file that takes their place.
CASE_OR_FILE = (
    *CASE,
    option("--nu", type=NUMBER, help="Poisson's ratio, 0 <= nu < 0.5, for the models that need one"),
    file("--problem", help="a problem file in physical units instead of n, k, mu and nu; results are in SI"),
)

#: A problem file whose keys may be varied.
VARIED_FILE = (
    file("--problem", help="a problem file instead, whose keys may be varied; results are in SI"),
    option(
        "--vary",
        metavar="KEY=VALUES",
        action="append",
        help="values of a key of the problem file: SECTION.KEY=A, B, C UNIT or SECTION.KEY=FIRST:LAST:NUMBER UNIT",
    ),
)

#: Number of processes.
JOBS = option("--jobs", metavar="N", type=INTEGER, default=usable_cores(), help="processes (default: one per core)")
#: Folder for the results.
OUT = file("--out", metavar="DIR", help="folder for the results (default: results/runs/TIME); results in it are kept")
#: Leaves out all but failures.
QUIET = option("--quiet", action="store_true", help="print only warnings and failures")
#: Prints all rows.
VERBOSE = option("--verbose", action="store_true", help="print every gate, not only a summary")


def problem_of(args: argparse.Namespace) -> Problem:
    """Return the problem of the arguments; `ValueError` if it is inadmissible, not complete or stated twice."""
    from comparisons.problem import PARAMETERS, Problem

    numbers: dict[str, Any] = {name: getattr(args, name, None) for name in PARAMETERS}
    if getattr(args, "problem", None) is not None:
        if twice := [f"--{name}" for name, number in numbers.items() if number is not None]:
            raise ValueError(f"{', '.join(twice)} and --problem exclude each other: the file states the whole problem")
        return Problem.load(args.problem)
    if missing := [f"--{name}" for name in PARAMETERS[:3] if numbers[name] is None]:
        instead = "; or give a file with --problem FILE" if "problem" in args else ""
        raise ValueError(f"the following arguments are required: {', '.join(missing)}{instead}")
    return Problem.dimensionless(**numbers)
