"""Entry point of ``fscm-bench`` and of ``python -m comparisons``."""

from __future__ import annotations

import sys
from pathlib import Path

from comparisons.console.exit_status import guarded
from comparisons.console.installation import check_packages

__all__ = ["main"]


def main() -> int:
    """Run the command line; return the exit status."""
    return guarded(_command, _program())


def _program() -> str:
    """Return the name by which the user started the program."""
    return "python -m comparisons" if Path(sys.argv[0]).name == "__main__.py" else "fscm-bench"


def _command() -> int:
    check_packages()
    # Imported here: an interruption during the import, which takes seconds, is one sentence as well.
    from comparisons.cli.main import main as command

    return command(program=_program())


if __name__ == "__main__":
    sys.exit(main())
