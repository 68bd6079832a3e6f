"""Start of the program ``fscm-bench``, a package whose name no other project has, unlike `comparisons`.

It imports nothing but the standard library before it has found the package `comparisons` of fscm-bench.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec

__all__ = ["main"]

#: As `comparisons.console.exit_status.WRONG_INPUT`, which cannot be imported where this is needed.
_WRONG_INPUT = 2


def main() -> int:
    """Run the command line; return the exit status, 2 if Python finds another package `comparisons`."""
    try:
        from comparisons.__main__ import main as command
    except ModuleNotFoundError:
        spec = find_spec("comparisons")
        found = "no package comparisons"
        if spec is not None:
            found = f"another package comparisons ({spec.origin or ', '.join(spec.submodule_search_locations or [])})"
        print(
            f"fscm-bench: Python finds {found} before that of fscm-bench: take its folder out of PYTHONPATH, or "
            "install fscm-bench in a virtual environment of its own",
            file=sys.stderr,
        )
        return _WRONG_INPUT
    return command()
