"""Function that makes a leaderboard from the folders of runs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from comparisons.console.progress import log
from comparisons.output.report.leaderboard import Entry, leaderboard_html
from comparisons.output.report.stored_run import Stored, read_folder
from comparisons.pipeline.inputs import stored_cases
from comparisons.runs.cases import VERIFICATION
from comparisons.runs.folder import RunFolder
from comparisons.runs.rows import Key
from comparisons.runs.tasks import plan

__all__ = ["leaderboard"]


def leaderboard(folders: Sequence[Path], mixed: bool = False) -> str:
    """Return the page of a leaderboard as HTML, one file without any other.

    Parameters
    ----------
    folders : sequence of Path
        Of finished runs, sweeps or comparisons; a folder that is named twice counts once.
    mixed : bool
        Whether runs of different cases or gates may stand on one page, which then states it.

    Raises
    ------
    ValueError
        If a folder is not that of a finished run, a file of it was changed, it holds a part of a sweep, or the runs
        have different cases or gates and `mixed` is false.
    """
    entries = [_entry(folder) for folder in {folder.resolve(): folder for folder in folders}.values()]
    return leaderboard_html(entries, mixed)


def _entry(folder: Path) -> Entry:
    stored = read_folder(folder)
    if part := stored.record["arguments"].get("shard"):
        raise ValueError(f"{folder} is the part {part} of a sweep: put the parts together with fscm-bench merge first")
    return Entry(str(folder), stored, _planned(folder, stored))


def _planned(folder: Path, stored: Stored) -> dict[Key, str] | None:
    """Return the keys of the results that the tables of errors are about, with their references."""
    arguments = stored.record["arguments"]
    cases = stored_cases(RunFolder(folder), arguments["tier"], arguments["model"])
    if cases.sha256 != stored.record["cases_sha256"]:
        log(f"the standing cases have changed since {folder} was computed: its coverage counts every stored result")
        return None
    grids = [grid for grid in cases.grids if cases.tier is None or VERIFICATION not in grid.tags]
    return {task.key: grid.reference for grid in grids for task in plan([grid], arguments["model"])}
