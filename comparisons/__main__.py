"""Entry point of ``fscm-bench`` and of ``python -m comparisons``."""

from __future__ import annotations

import os
import sys

if __name__ == "__main__" and not sys.flags.safe_path:
    # `python -m` puts the working folder first, which may hold a model and modules of any name.
    sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

from comparisons.console.exit_status import guarded


def main() -> int:
    """Run the command line; return the exit status."""
    # Nor do worker processes, whose interpreters start in the working folder, import from there.
    os.environ["PYTHONSAFEPATH"] = "1"
    return guarded(_command, _program())


def _program() -> str:
    """Return the name by which the user started the program."""
    return "python -m comparisons" if os.path.basename(sys.argv[0]) == "__main__.py" else "fscm-bench"


def _command() -> int:
    # Imported here: an interruption during the import, which takes seconds, is one sentence as well.
    from comparisons.cli.main import main as command

    return command(program=_program())


if __name__ == "__main__":
    sys.exit(main())
