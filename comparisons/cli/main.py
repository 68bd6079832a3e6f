"""The command line: its parser, the call of a command, and the exit status.

Results go to stdout, progress and messages to stderr.  Exit status: 0 done and every gate passes, 1 a gate
fails, 2 wrong input, 3 a gate is inconclusive, 4 a computation or an output failed (as on a full disk), a gate is in
error, or there was nothing to judge (and, as shells have it, 130 after Ctrl-C, 141 when the reader of a pipe went
away, and 143 after SIGTERM).

A command ``NAME`` is a function ``NAME_command`` in a module of `comparisons.cli.commands`, with its options, and with
the examples of its help in its text; it returns the exit status.  A library such as click would not shorten it: none
has options with several values (``--model jkr dmt``), and the help must not import what a command needs.

For example::

    fscm-bench run
    fscm-bench solve --model fscm --quantity pull_off_force --n 2 --k 0.4 --mu 1
    fscm-bench COMMAND --help
"""

from __future__ import annotations

import argparse
import logging
import re
import sys
import textwrap
from collections.abc import Collection, Sequence
from contextlib import AbstractContextManager, nullcontext
from importlib import import_module
from inspect import getdoc
from typing import TYPE_CHECKING, Any, NoReturn

from comparisons.console.exit_status import FAILED, guarded

if TYPE_CHECKING:
    from comparisons.cli.options import Command

#: Command -> its module, which is imported when it is called, and its line of the help.
_COMMANDS = {
    "run": ("runs", "compute the standing cases and judge them"),
    "judge": ("runs", "judge stored results again, by the same gates or others, without computing"),
    "report": ("pages", "write one HTML page of a run"),
    "supplement": ("pages", "write the supplement of a paper: tables, figures, Methods, references and data of a run"),
    "board": (
        "pages",
        "judge a folder of submitted models and write a web site: errors, verdicts, report cards, history",
    ),
    "paper": ("evidence", "compute the figures and numbers of the paper again"),
    "sweep": ("sweeps", "compute any number of your own cases, without gates"),
    "compare": ("sweeps", "compare models with a reference in your own cases: one table, one figure"),
    "merge": ("sweeps", "put the shards of a sweep into one folder"),
    "solve": ("solve", "compute one quantity of one problem by one model"),
    "curve": (
        "curve",
        "compute force-displacement curves (the whole equilibrium path, or with --stiffness approach and retreat), "
        "or pressure or gap at pull-off, as CSV and as a plot",
    ),
    "describe": ("describe", "print pull-off force, Tabor number and recommended models of a problem file"),
    "new-problem": ("problems", "write a commented problem file of the kinds of solid, punch and law that you name"),
    "fit": ("fit", "fit work of adhesion, modulus and other values to measured force-displacement curves"),
    "fem": (
        "fem",
        "write fields of the finite elements (vtu, picture); print their verification and the study of the solvers",
    ),
    "list": ("listing", "list the models, quantities, cases, gates, or the kinds of a problem file"),
    "check-model": ("models", "check that an external model keeps the contract"),
    "new-model": ("models", "write a template for your own model: a package with a test and a CI workflow"),
    "cite": ("citing", "print how to cite fscm-bench and what a run used, as text or BibTeX"),
    "bench": ("evidence", "measure error, time and memory of the solvers on this machine, as ratios"),
}

_EXIT_STATUS = """
Exit status: 0 done and every gate passes, 1 a gate fails, 2 wrong input,
3 a gate is inconclusive, 4 a computation or an output failed, a gate is in
error, or no gate was evaluated."""


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one sentence, without the usage, and whose help keeps the lines of examples."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings, formatter_class=argparse.RawDescriptionHelpFormatter)
        # The pattern of argparse does not know -1e-3, which it takes for an option.
        self._negative_number_matcher = re.compile(r"-(\d|\.\d|inf|nan)")

    def error(self, message: str) -> NoReturn:
        raise ValueError(f"{message}; see {self.prog} --help")

    def _print_message(self, message: str, file: Any = None) -> None:
        # The help; the method of argparse is silent when it cannot be written.
        print(message, end="", file=file or sys.stderr)


class _Version(argparse.Action):
    """The option that prints the version, which takes a moment to find out."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from comparisons.runs.environment import version_text

        print(f"fscm-bench {version_text()}")
        parser.exit()


def _examples(text: str) -> str:
    """The commands in a text, each on an indented line."""
    commands = [line.strip() for line in text.splitlines() if line.startswith("    fscm-bench ")]
    return "\n  ".join(["example:" if len(commands) == 1 else "examples:", *commands])


def _parser(called: Collection[str], program: str = "fscm-bench") -> argparse.ArgumentParser:
    """The parser, with the options of the commands that are called."""
    parser = _Parser(
        prog=program,
        description="How wrong is a model of adhesive contact, and how certain is that error?",
        epilog=f"{_examples(__doc__)}\n{_EXIT_STATUS}",
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and, if known, the commit")
    parsers = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, (module, text) in _COMMANDS.items():
        subparser = parsers.add_parser(name, help=text, description=textwrap.fill(f"{text[0].upper()}{text[1:]}."))
        if name in called:
            commands = import_module(f"comparisons.cli.commands.{module}")
            command: Command = getattr(commands, f"{name.replace('-', '_')}_command")
            subparser.epilog = _examples(getdoc(command.call) or "")
            subparser.set_defaults(call=command.call)
            for names, settings in command.options:
                subparser.add_argument(*names, **settings)
    return parser


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
    args = _parser(called, program).parse_args(arguments)
    # Not needed for the help.
    from comparisons.console.progress import log, quiet

    # Embedding a font in a PDF, it remarks on the date in the font's file.
    logging.getLogger("fontTools").setLevel(logging.ERROR)
    with _one_thread(), quiet() if getattr(args, "quiet", False) else nullcontext():
        try:
            status: int = args.call(args)
        except Exception as failure:
            # Imported here: a command that computes nothing does not need it.
            from comparisons.model import ComputationFailed

            if not isinstance(failure, ComputationFailed):
                raise
            log(str(failure))
            return FAILED
    return status


def _one_thread() -> AbstractContextManager[Any]:
    """One thread for BLAS: processes share the work, and sums come in the same order every time."""
    if "numpy" not in sys.modules:
        # A command that computes has loaded it with its module.
        return nullcontext()
    from threadpoolctl import threadpool_limits

    return threadpool_limits(1)
