"""Completion of the command line by the Tab key of bash, zsh and tcsh."""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS

__all__ = ["completion_script"]

_NAMES = " ".join(MODELS)

#: Function of the scripts that completes the name of a model of ours or else of a file; those of tcsh have none.
_MODEL = "_fscm_bench_models"
_PREAMBLE = {
    "bash": f'{_MODEL}() {{ compgen -W "{_NAMES}" -- "$1"; compgen -f -- "$1"; }}\n',
    "zsh": f"{_MODEL}() {{ _alternative 'models:model:({_NAMES})' 'files:file:_files' }}\n",
}
_COMPLETES_MODEL = {"bash": _MODEL, "zsh": _MODEL, "tcsh": f"`echo {_NAMES}; ls`"}


def completion_script(parser: argparse.ArgumentParser, shell: str) -> str:
    """Return the script that a shell, bash, zsh or tcsh, reads.

    Parameters
    ----------
    parser : ArgumentParser
        With the arguments of every command; it is changed, and reads no arguments afterwards.
    shell : str

    Raises
    ------
    ModuleNotFoundError
        If shtab is not installed.
    """
    import shtab

    _complete(parser)
    script: str = shtab.complete(parser, shell, root_prefix="fscm_bench", preamble=_PREAMBLE.get(shell, ""))
    return script


def _complete(parser: argparse.ArgumentParser) -> None:
    """State for each argument without choices what completes it."""
    import shtab

    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                _complete(command)
        elif action.type is Path:
            folder = str(action.metavar or "").startswith("DIR")
            vars(action)["complete"] = shtab.DIRECTORY if folder else shtab.FILE
        elif action.metavar in ("SPEC", "MODEL"):
            vars(action)["complete"] = _COMPLETES_MODEL
        elif action.dest == "quantity":
            action.choices = action.choices or tuple(ALL_QUANTITIES)
