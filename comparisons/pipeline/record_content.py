"""Content of the record that every command writes into its folder."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from comparisons.runs.environment import environment
from comparisons.runs.record import FORMAT

__all__ = ["now", "record_content"]


def now() -> str:
    """Return the time as a record has it."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def record_content(
    command_name: str,
    arguments: Mapping[str, Any],
    *,
    started: str,
    parts: Sequence[Mapping[str, Any]],
    rows: Mapping[str, int],
    seconds: Mapping[str, float],
    verdicts: Mapping[str, str | int],
) -> dict[str, Any]:
    """Return the entries that the records of a run, of a sweep and of the paper have in common.

    Parameters
    ----------
    command_name : str
        "run", "sweep" or "paper".
    arguments : mapping
        The arguments of the command, by name.
    started : str
        When this command began; a resumed one began with the first of its parts.
    parts : sequence of mapping
        The commands that computed the rows (`comparisons.runs.store.Store.parts`).
    rows : mapping of str to int
        Numbers of rows: all, resumed, and by status.
    seconds : mapping of str to float
        Computing time by model.
    verdicts : mapping
        The verdict over all and the number of cases with each; empty if nothing was judged.
    """
    return {
        "format": FORMAT,
        "command_name": command_name,
        "arguments": dict(arguments),
        "command": [Path(sys.argv[0]).name, *sys.argv[1:]],
        "started": parts[0]["started"] if parts else started,
        "finished": now(),
        "seconds": {"run": sum(part["seconds"] for part in parts), "by_model": dict(seconds)},
        "parts": list(parts),
        "rows": dict(rows),
        "verdicts": dict(verdicts),
        **environment(),
    }
