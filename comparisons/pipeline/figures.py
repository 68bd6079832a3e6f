"""Function for the figures of the paper: their computation, tables, pictures and record."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from comparisons.data.file_names import RECORD
from comparisons.model import ComputationFailed
from comparisons.paper.cache import CachedCall, Outcome, make_calls
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.registry import paper_figures
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.computation import checked_jobs
from comparisons.runs.folder_lock import locked
from comparisons.runs.record import now, record_content, write_record


@dataclass(frozen=True, slots=True)
class FinishedFigure:
    """A figure, its tables and the files that were written; tables and files are empty if it failed.

    `failure` is the reason, or empty.
    """

    figure: PaperFigure
    tables: Tables
    files: tuple[Path, ...]
    failure: str = ""


def make_figures(names: Iterable[str] | None, folder: Path, *, jobs: int = 1) -> tuple[FinishedFigure, ...]:
    """Compute figures of the paper and write their tables, pictures and texts, and the record, into a folder.

    Parameters
    ----------
    names : iterable of str or None
        Names of figures, as in `comparisons.paper.registry.NAMES`; None for all.
    folder : Path
        For the files; what it holds already is not computed again, but for failures.
    jobs : int
        Number of processes.

    Raises
    ------
    ValueError
        If there is no figure of a name, or the folder holds results of other code.
    comparisons.model.ComputationFailed
        If a worker process dies.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     finished = make_figures(["12"], Path(folder))
    ...     sorted(path.name for path in Path(folder).glob("*.json"))
    ['run.json']
    >>> [figure.failure for figure in finished]
    ['']
    """
    checked_jobs(jobs)
    wanted = None if names is None else list(names)
    figures = paper_figures(wanted)
    with locked(prepare_folder(folder)):
        started = now()
        calls = dict.fromkeys(call for figure in figures for call in figure.plan().needed)
        computed = make_calls(calls, folder, jobs)
        finished = tuple(_finished(figure, computed.outcomes, folder) for figure in figures)
        failed = sum(computed.outcomes[call].failed for call in calls)
        record = record_content(
            "paper",
            {"figure": wanted},
            started=started,
            parts=computed.parts,
            seconds={},
            rows={
                "all": len(calls),
                "resumed": len(calls) - computed.made,
                "ok": len(calls) - failed,
                "failed": failed,
            },
        )
        write_record(record, folder / RECORD, [path.name for figure in finished for path in figure.files])
    return finished


def _finished(figure: PaperFigure, outcomes: dict[CachedCall, Outcome], folder: Path) -> FinishedFigure:
    try:
        tables = figure.plan().given(outcomes)
        return FinishedFigure(figure, tables, tuple(figure.write(tables, folder)))
    except ComputationFailed as failure:
        return FinishedFigure(figure, {}, (), str(failure))
