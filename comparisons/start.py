"""Where the console script begins: an interruption while everything is still being imported is one sentence too."""

from __future__ import annotations

import sys

__all__ = ["main"]


def main() -> int:
    """Run the command line; return the exit status."""
    try:
        # Imported here: it takes seconds, in which somebody may change their mind.
        from comparisons.cli import main as command

        return command()
    except KeyboardInterrupt:
        print("fscm-bench: interrupted", file=sys.stderr)
        return 130
