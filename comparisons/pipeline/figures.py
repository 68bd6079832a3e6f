"""Function for the figures of the paper: their computation, tables, pictures and record."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from comparisons.console.progress import counting
from comparisons.model import ComputationFailed
from comparisons.paper.cache import CachedCall, CallCache
from comparisons.paper.paper_figure import PaperFigure, Tables, calls_of, given
from comparisons.paper.registry import paper_figures
from comparisons.pipeline.record_content import now, record_content
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.computation import checked_jobs, log_failures_used
from comparisons.runs.environment import fingerprint
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import write_record
from comparisons.runs.store import alone_in

__all__ = ["FinishedFigure", "FinishedPaper", "make_figures"]


@dataclass(frozen=True, slots=True)
class FinishedFigure:
    """A figure, its tables and the files that were written; tables and files are empty if it failed.

    `failure` is the reason, or empty.
    """

    figure: PaperFigure
    tables: Tables
    files: tuple[Path, ...]
    failure: str = ""


@dataclass(frozen=True, slots=True)
class FinishedPaper:
    """The folder of the figures, and each figure."""

    folder: Path
    figures: tuple[FinishedFigure, ...]

    @property
    def failures(self) -> dict[str, str]:
        """Name of each figure that failed -> the reason."""
        return {one.figure.stem: one.failure for one in self.figures if one.failure}


def make_figures(
    names: Iterable[str] | None, folder: Path, *, jobs: int = 1, retry_failed: bool = False
) -> FinishedPaper:
    """Compute figures of the paper and write their tables, pictures and texts, and the record, into a folder.

    Parameters
    ----------
    names : iterable of str or None
        Names of figures, as in `comparisons.paper.registry.NAMES`; None for all.
    folder : Path
        For the files; what it holds already is not computed again.
    jobs : int
        Number of processes.
    retry_failed : bool
        Whether stored failures are computed again.

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
    ...     finished = make_figures(["1"], Path(folder))
    ...     sorted(path.name for path in Path(folder).glob("*.json"))
    ['run.json']
    >>> finished.failures
    {}
    """
    checked_jobs(jobs)
    wanted = None if names is None else list(names)
    chosen = paper_figures(wanted)
    target = RunFolder(prepare_folder(folder))
    started = now()
    calls = [call for figure in chosen for call in calls_of(figure.plan())]
    cache, missing = _computed(calls, target, jobs, retry_failed)
    finished = tuple(_finished(figure, cache, folder) for figure in chosen)
    distinct = dict.fromkeys(calls)
    failed = len(cache.failed(calls))
    content = record_content(
        "paper",
        {"figure": wanted, "jobs": jobs, "out": str(folder)},
        started=started,
        parts=cache.parts_of(calls),
        rows={
            "all": len(distinct),
            "resumed": len(distinct) - missing,
            "ok": len(distinct) - failed,
            "failed": failed,
        },
        seconds={},
        verdicts={},
    )
    write_record(content, target.record, [path.name for one in finished for path in one.files])
    return FinishedPaper(folder, finished)


def _computed(calls: list[CachedCall], folder: RunFolder, jobs: int, retry_failed: bool) -> tuple[CallCache, int]:
    """Make the calls that are missing; return the cache and the number of these calls."""
    with alone_in(folder.path):
        cache = CallCache(folder.calls, fingerprint())
        failed = cache.failed(calls)
        if retry_failed:
            cache.forget(failed)
        else:
            log_failures_used(Counter(call.function.partition(":")[2] for call in failed))
        missing = cache.missing(calls)
        with cache.kept(), counting("paper", len(missing)) as advance, closing(cache.work(missing, jobs)) as done:
            for _ in done:
                advance()
    return cache, len(missing)


def _finished(figure: PaperFigure, cache: CallCache, folder: Path) -> FinishedFigure:
    try:
        tables = given(figure.plan(), cache.results)
        return FinishedFigure(figure, tables, tuple(figure.write(tables, folder)))
    except ComputationFailed as failure:
        return FinishedFigure(figure, {}, (), str(failure))
