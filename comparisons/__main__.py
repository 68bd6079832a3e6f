"""Start of the console script: an exception while everything is still being imported is one sentence too."""

from __future__ import annotations

from comparisons.console.exit_status import guarded

__all__ = ["main"]


def main() -> int:
    """Run the command line; return the exit status."""
    return guarded(_command)


def _command() -> int:
    # Imported here: it takes seconds, in which somebody may change their mind.
    from comparisons.cli.main import main as command

    return command()
