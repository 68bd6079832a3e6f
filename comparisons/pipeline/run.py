"""Function for a whole run: its computation, tables, verdicts and record."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from comparisons.pipeline.finished_run import FinishedRun, kept_texts, write_run
from comparisons.pipeline.inputs import RunInputs, load_cases, read_gates
from comparisons.pipeline.record_content import now
from comparisons.pipeline.results import results
from comparisons.registry import identify
from comparisons.runs.backends import backend_of
from comparisons.runs.computation import checked_jobs, folder_for
from comparisons.runs.folder import RunFolder
from comparisons.runs.shards import Shard

__all__ = ["run"]


def run(
    cases: str | Path = "quick",
    gates: str | Path | None = None,
    models: Sequence[str] | None = None,
    folder: Path | None = None,
    *,
    jobs: int = 1,
    retry_failed: bool = False,
    recompute: bool = False,
    backend: str = "processes",
    scheduler: str | None = None,
    shard: str | None = None,
) -> FinishedRun:
    """Compute cases, judge the results, and write tables, verdicts and the record into a folder.

    What the folder holds already is not computed again, and in the standing cases neither is what is shipped with the
    package.  With models and gates, only the results that the gates need are computed.

    Parameters
    ----------
    cases : str or Path
        A tier of the standing cases ("quick" or "full"), a file of [[grid]] tables without a tier, or the text of one.
    gates : str, Path or None
        A gates file, or the text of one; by default the standing gates for the standing cases, and no gates for others.
    models : sequence of str, optional
        Names or SPECs of the candidates, in place of those each grid names.
    folder : Path, optional
        For the results; by default one in results/runs that is named by the time.
    jobs : int
        Number of processes.  With more than one, a script needs the guard ``if __name__ == "__main__":``.
    retry_failed : bool
        Whether stored failures are computed again.
    recompute : bool
        Whether the values of the references are computed although they are shipped.
    backend : str
        Where it is computed: "processes" of this machine, or "dask" for a Dask cluster.
    scheduler : str, optional
        The address of the scheduler of a Dask cluster; by default a cluster is started on this machine.
    shard : str, optional
        The part i/N of cases without gates, as "2/3"; `comparisons.pipeline.merge.merge` puts the N folders together.

    Returns
    -------
    FinishedRun

    Raises
    ------
    ValueError
        If an argument is not admissible, or the folder holds results of other code or files of a user.
    comparisons.model.ComputationFailed
        If the workers cannot compute, or a shipped value is not confirmed.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> grid = '''
    ... [[grid]]
    ... id = "mine"
    ... title = "JKR beside Bradley"
    ... reference = "bradley"
    ... models = ["jkr"]
    ... quantities = ["pull_off_force"]
    ... n = [2]
    ... k = [0]
    ... mu = [1]
    ... '''
    >>> with TemporaryDirectory() as folder:
    ...     finished = run(grid, folder=Path(folder))
    >>> finished.verdict, finished.counts["ok"], finished.tables.kappa["kappa"].round(6).tolist()
    (None, 2, [-0.25])
    """
    checked_jobs(jobs)
    workers = backend_of(backend, scheduler)
    part = None if shard is None else Shard.parse(shard)
    # Before anything is computed or written, every model is loaded and every text is read.
    names, external = identify(models or [])
    chosen_models = None if models is None else names
    chosen = load_cases(cases, chosen_models)
    rules = None if chosen.tier is None and gates is None else read_gates(gates, chosen, chosen_models)
    if part is not None and rules is not None:
        raise ValueError(f"shard {part} of a run cannot be judged: only cases without gates are computed in shards")
    started, start = datetime.now(UTC), now()
    target = RunFolder(folder_for(folder, started))
    kept_texts(target, chosen, rules)
    inputs = RunInputs(chosen, rules, chosen_models, external)
    tasks = inputs.plan() if part is None else part.of(inputs.plan())
    found = results(
        tasks,
        chosen,
        rules,
        chosen_models,
        target.path,
        jobs=jobs,
        retry_failed=retry_failed,
        recompute=recompute,
        backend=workers,
    )
    others = {"backend": None if backend == "processes" else backend, "scheduler": scheduler, "shard": shard}
    arguments = {"jobs": jobs, **{name: value for name, value in others.items() if value is not None}}
    return write_run(target, inputs, found, arguments, start)
