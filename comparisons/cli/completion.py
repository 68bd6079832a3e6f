"""Completion of the command line by the Tab key of bash, zsh and tcsh."""

from __future__ import annotations

import argparse
from pathlib import Path

from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS

__all__ = ["SHELLS", "completion_script"]

#: Shells with a script.
SHELLS = ("bash", "zsh", "tcsh")

#: Functions of the scripts: the names of our models or else files, and the names of the quantities.
_MODELS, _QUANTITIES = "_fscm_bench_models", "_fscm_bench_quantities"

#: The same for tcsh, whose scripts have no functions: a command that prints words, and a list.
_TCSH_MODELS, _TCSH_QUANTITIES = f"`echo {' '.join(MODELS)}; ls`", f"({' '.join(ALL_QUANTITIES)})"


def completion_script(parser: argparse.ArgumentParser, shell: str) -> str:
    """Return the script that a shell reads.

    Parameters
    ----------
    parser : ArgumentParser
        With the arguments of every command.
    shell : str
        Of `SHELLS`.

    Raises
    ------
    ValueError
        If shtab is not installed, or does not know the shell.
    """
    if shell not in SHELLS:
        raise ValueError(f"--print-completion {shell}: the shell is none of {', '.join(SHELLS)}")
    try:
        import shtab
    except ImportError:
        raise ValueError(
            "--print-completion needs the package shtab, which is not installed: pip install 'fscm-bench[completion]'"
        ) from None
    _complete(parser)
    script: str = shtab.complete(parser, shell, root_prefix="fscm_bench", preamble=_preamble().get(shell, ""))
    return script


def _preamble() -> dict[str, str]:
    models, quantities = " ".join(MODELS), " ".join(ALL_QUANTITIES)
    bash = f'{_MODELS}() {{ compgen -W "{models}" -- "$1"; compgen -f -- "$1"; }}\n'
    bash += f'{_QUANTITIES}() {{ compgen -W "{quantities}" -- "$1"; }}\n'
    zsh = f"{_MODELS}() {{ _alternative 'models:model:({models})' 'files:file:_files' }}\n"
    zsh += f"{_QUANTITIES}() {{ _values quantity {quantities} }}\n"
    return {"bash": bash, "zsh": zsh}


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
            vars(action)["complete"] = {"bash": _MODELS, "zsh": _MODELS, "tcsh": _TCSH_MODELS}
        elif action.dest == "quantity" and action.choices is None:
            vars(action)["complete"] = {"bash": _QUANTITIES, "zsh": _QUANTITIES, "tcsh": _TCSH_QUANTITIES}
