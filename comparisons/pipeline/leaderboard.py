"""Function that makes a leaderboard from the folders of runs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from comparisons.console.progress import log
from comparisons.output.report.leaderboard import Entry, leaderboard_html
from comparisons.output.report.stored_run import read_folder
from comparisons.pipeline.inputs import stored_inputs
from comparisons.runs.tasks import plan


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
    entries = [entry_of(folder) for folder in {folder.resolve(): folder for folder in folders}.values()]
    return leaderboard_html(entries, mixed)


def entry_of(folder: Path) -> Entry:
    """Return the results of a folder with the keys that its tables of errors are about, and their references."""
    stored = read_folder(folder)
    if shard := stored.record["arguments"].get("shard"):
        raise ValueError(f"{folder} is the part {shard} of a sweep: put the parts together with fscm-bench merge first")
    inputs = stored_inputs(folder, stored.record)
    if inputs.cases.sha256 != stored.record["cases_sha256"]:
        log(f"the standing cases have changed since {folder} was computed: its coverage counts every stored result")
        return Entry(str(folder), stored, None)
    planned = {task.key: grid.reference for grid in inputs.cases.compared for task in plan([grid], inputs.models)}
    return Entry(str(folder), stored, planned)
