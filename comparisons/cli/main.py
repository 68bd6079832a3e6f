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
from collections.abc import Collection, Sequence
from importlib import import_module
from typing import Any, NoReturn

from comparisons.cli.help_text import HelpFormatter, description_of, examples_text
from comparisons.console.exit_status import guarded

__all__ = ["main"]

#: Command -> its module in `comparisons.cli.commands`, and its line of the help.  A module is imported when its
#: command is called, so that the help does not wait for the libraries of all commands.
_COMMANDS = {
    "run": ("run", "compute the standing cases and judge them"),
    "judge": ("judge", "judge stored results again without computing"),
    "report": ("report", "write a run as one HTML page"),
    "leaderboard": ("leaderboard", "write any number of runs as one sortable HTML table"),
    "paper": ("paper", "compute the figures and numbers of the paper again"),
    "sweep": ("sweep", "compute grids of one's own"),
    "compare": ("compare", "compare models with a reference in cases of one's own: one table, one figure"),
    "merge": ("merge", "put the shards of a sweep into one folder"),
    "solve": ("solve", "compute one quantity of one problem by one model"),
    "curve": ("curve", "compute curves or surfaces at pull-off, as CSV and as a plot"),
    "describe": ("describe", "Tabor number, pull-off force and admissible models of a problem file"),
    "fem": ("fem", "write fields of the finite elements (vtu, picture), print their verification and solver tables"),
    "list": ("listing", "list the models, quantities, cases or gates"),
    "check-model": ("check_model", "check that an external model keeps the contract"),
    "new-model": ("new_model", "write a template for a model of your own"),
    "cite": ("cite", "print how to cite fscm-bench and what a run used, as text or BibTeX"),
    "bench": ("bench", "measure error, time and memory of the solvers on this machine, as ratios"),
}


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one sentence, without the usage."""

    def error(self, message: str) -> NoReturn:
        raise ValueError(f"{message}; see {self.prog} --help")

    def _print_message(self, message: str, file: Any = None) -> None:
        # The help and the version; the method of argparse is silent when they cannot be written.
        print(message, end="", file=file or sys.stderr)


class _Version(argparse.Action):
    """The option --version; the version is read when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from comparisons.runs.environment import version_text

        print(f"fscm-bench {version_text()}")
        parser.exit()


class _Completion(argparse.Action):
    """The option --print-completion."""

    def __call__(self, parser: argparse.ArgumentParser, _: argparse.Namespace, shell: Any, *__: Any) -> None:
        from comparisons.cli.completion import completion_script

        print(completion_script(_parser(list(_COMMANDS)), shell), end="")
        parser.exit()


#: The end of the help.
_EXIT_STATUS = (
    "Exit status: 0 done and every gate passes, 1 a gate fails, 2 wrong input, 3 inconclusive, 4 a computation or an "
    "output failed, a gate is in error, or no gate was evaluated."
)
_EXAMPLES = (
    "fscm-bench run",
    "fscm-bench solve --model fscm --quantity pull_off_force --n 2 --k 0.4 --mu 1",
    "fscm-bench COMMAND --help",
)


def _parser(called: Collection[str], program: str = "fscm-bench") -> argparse.ArgumentParser:
    """The parser, with the arguments of the commands that are called."""
    parser = _Parser(
        prog=program,
        description="How wrong is a model of adhesive contact of graded materials, and how certain is that error?",
        epilog=f"{examples_text(_EXAMPLES)}\n\n{_EXIT_STATUS}",
        formatter_class=HelpFormatter,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and, if known, the commit")
    parser.add_argument(
        "--print-completion",
        metavar="SHELL",
        action=_Completion,
        help="print the script that completes commands in bash, zsh or tcsh",
    )
    parsers = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, (module_name, text) in _COMMANDS.items():
        command = parsers.add_parser(name, help=text, formatter_class=HelpFormatter)
        if name in called:
            module = import_module(f"comparisons.cli.commands.{module_name}")
            command.description = description_of(module.__doc__)
            command.epilog = examples_text(module.EXAMPLES)
            module.add(command)
            command.set_defaults(call=module.call)
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


def main(arguments: Sequence[str] | None = None, program: str = "fscm-bench") -> int:
    """Run one command.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows the program's name; by default that of this process.
    program : str
        The name by which it was started.

    Returns
    -------
    int
        The exit status.
    """
    return guarded(lambda: _call(sys.argv[1:] if arguments is None else arguments, program), program)


def _call(arguments: Sequence[str], program: str) -> int:
    called = [text for text in arguments if not text.startswith("-")][:1]
    args = _parser(called, program).parse_args(_keep_negative_numbers(arguments))
    # Not needed for the help.
    from threadpoolctl import threadpool_limits

    # Embedding a font in a PDF, it remarks on the date in the font's file.
    logging.getLogger("fontTools").setLevel(logging.ERROR)
    # One thread for BLAS: processes share the work, and sums come in the same order every time.
    with threadpool_limits(1):
        status: int = args.call(args)
    return status
