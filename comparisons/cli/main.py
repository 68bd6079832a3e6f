"""The command line: its parser, the call of a command, and the exit status.

Results go to stdout, progress and messages to stderr.  Exit status: 0 done and every gate passes, 1 a gate
fails, 2 wrong input, 3 a gate is inconclusive, 4 a computation or an output failed (as on a full disk), a gate is in
error, or there was nothing to judge (and, as shells have it, 130 after Ctrl-C, 141 when the reader of a pipe went
away, and 143 after SIGTERM).
"""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from threadpoolctl import threadpool_limits

from comparisons.cli.commands import (
    bench,
    check_model,
    curve,
    fem,
    judge,
    listing,
    new_model,
    paper,
    report,
    run,
    solve,
    sweep,
)
from comparisons.console.exit_status import guarded
from comparisons.runs.environment import package_version

__all__ = ["main"]

_COMMANDS = (run, judge, report, paper, sweep, solve, curve, fem, listing, check_model, new_model, bench)


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one sentence, without the usage."""

    def error(self, message: str) -> NoReturn:
        raise ValueError(f"{message}; see {self.prog} --help")

    def _print_message(self, message: str, file: Any = None) -> None:
        # The help and the version; the method of argparse is silent when they cannot be written.
        print(message, end="", file=file or sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="fscm-bench",
        description="How wrong is a model of adhesive contact of graded materials, and how certain is that error?",
        epilog="Exit status: 0 done and every gate passes, 1 a gate fails, 2 wrong input, 3 inconclusive, "
        "4 a computation or an output failed, a gate is in error, or no gate was evaluated.",
    )
    parser.add_argument("--version", action="version", version=f"fscm-bench {package_version()}")
    parsers = parser.add_subparsers(metavar="COMMAND", required=True)
    for command in _COMMANDS:
        command.add(parsers)
    return parser


def _keep_negative_numbers(arguments: Sequence[str]) -> list[str]:
    """Join ``--k -1e-3`` into ``--k=-1e-3``: argparse takes some negative numbers for options.

    Examples
    --------
    >>> _keep_negative_numbers(["solve", "--k", "-1e-3", "--n", "2"])
    ['solve', '--k=-1e-3', '--n', '2']
    """
    joined: list[str] = []
    for argument in arguments:
        if joined and joined[-1].startswith("--") and "=" not in joined[-1] and _is_negative(argument):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


def _is_negative(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return text.startswith("-")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows the program's name; by default that of this process.

    Returns
    -------
    int
        The exit status.
    """
    return guarded(lambda: _call(sys.argv[1:] if arguments is None else arguments))


def _call(arguments: Sequence[str]) -> int:
    # Embedding a font in a PDF, it remarks on the date in the font's file.
    logging.getLogger("fontTools").setLevel(logging.ERROR)
    args = _parser().parse_args(_keep_negative_numbers(arguments))
    # One thread for BLAS: processes share the work, and sums come in the same order every time.
    with threadpool_limits(1):
        status: int = args.call(args)
    return status
