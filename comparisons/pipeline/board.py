"""The board, a static site of submissions that are run and judged.

Whatever a submission raises is its own reason not to be judged, and the others are judged.
"""

from __future__ import annotations

import shutil
from pathlib import Path

from comparisons.console.exit_status import full_disk
from comparisons.console.progress import log, note
from comparisons.data.file_names import LOCK, REPORT, STORE
from comparisons.external.inherited import at_most, hidden_from_models
from comparisons.external.model_source import close_models
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed
from comparisons.output.report.board_page import BoardEntry, Entry, Submission, board_page
from comparisons.output.report.page import make_page
from comparisons.output.report.render import write_page
from comparisons.output.report.stored_run import read_folder
from comparisons.pipeline.inputs import stored_inputs
from comparisons.pipeline.run import run
from comparisons.pipeline.submission import SubmissionFolder, read_submission, submission_folders
from comparisons.pipeline.tables import REFERENCE
from comparisons.registry import create
from comparisons.runs.atomic_files import prepare_folder, write_file
from comparisons.runs.environment import fingerprint
from comparisons.runs.folder_lock import locked
from comparisons.runs.store import rows_in
from comparisons.runs.tasks import plan

#: Seconds in which the models of a submission, the report card among them, have to be evaluated; those of fscm-bench
#: need a few, and a job of GitHub has 360 minutes.
TOTAL_TIME = 1800.0

#: The first page of the site, and the file that names the code of its results.
INDEX, _CODE = "index.html", "code.txt"


def make_board(submissions: Path, site: Path, jobs: int = 1) -> list[BoardEntry]:
    """Judge submissions in the standing cases and write their pages, the run folders behind them, and the first page.

    A submission that cannot be judged is an entry with the reason.  What the site holds already is not computed again,
    unless the submission or the code of fscm-bench has changed.

    Parameters
    ----------
    submissions : Path
        A folder of submissions, or one submission.
    site : Path
        Folder for the site.
    jobs : int
        Number of processes.

    Returns
    -------
    list of BoardEntry
        The submissions in the order of their folders.

    Raises
    ------
    ValueError
        If there is no submission, `site` holds files that are not of a board, or another process makes one in it.
    OSError
        If a file cannot be written.
    """
    folders = submission_folders(submissions)
    prepare_folder(site)
    if not (site / _CODE).exists() and any(path.name != LOCK for path in site.iterdir()):
        raise ValueError(f"{site} holds files that are not of a board; choose another folder with --out")
    # Another board in it would remove the results of this one.
    with locked(site):
        return _made(folders, site, jobs)


def _made(folders: list[SubmissionFolder], site: Path, jobs: int) -> list[BoardEntry]:
    """Judge submissions and write the pages of a site that this process has locked."""
    _prepare(site)
    entries: list[BoardEntry] = []
    for submission in folders:
        note(f"submission {submission.path}")
        entries.append(_entry(submission, site, entries, jobs))
        # Each model is a process, which is not needed any more.
        close_models()
    _remove_others(site, entries)
    write_page(board_page(entries), site / INDEX)
    return entries


def _prepare(site: Path) -> None:
    """Remove results of other code from a site."""
    code = site / _CODE
    if not code.exists() or code.read_text(encoding="utf-8") != fingerprint():
        shutil.rmtree(site / "models", ignore_errors=True)
        write_file(code, fingerprint())


def _remove_others(site: Path, entries: list[BoardEntry]) -> None:
    """Remove the results of submissions that are not there any more, or are not judged."""
    judged = {site / entry.submission.folder for entry in entries if entry.submission and entry.judged}
    for folder in (site / "models").glob("*/*"):
        if folder not in judged:
            shutil.rmtree(folder)


def _entry(folder: SubmissionFolder, site: Path, earlier: list[BoardEntry], jobs: int) -> BoardEntry:
    """Return a submission with its results, or with the reason why it has none."""
    submission = None
    try:
        submission = read_submission(folder)
        if submission.folder.lower() in [entry.submission.folder.lower() for entry in earlier if entry.submission]:
            raise ValueError(f"{submission.name} {submission.version} is there twice: each needs its own version")
        # Its model does not read the results of the references, nor those beside the results of others.
        with at_most(TOTAL_TIME), hidden_from_models(site):
            _judge(submission, site, earlier, jobs)
        judged = entry_of(site / submission.folder)
    except Exception as error:
        if isinstance(error, OSError) and full_disk(error):
            raise
        is_sentence = isinstance(error, ValueError | ComputationFailed)
        reason = one_line(str(error) if is_sentence else f"it cannot be judged ({type(error).__name__}: {error})")
        log(f"{folder.path} is not judged: {reason}")
        return BoardEntry(folder.path, submission, None, reason)
    return BoardEntry(folder.path, submission, judged)


def _judge(submission: Submission, site: Path, earlier: list[BoardEntry], jobs: int) -> None:
    """Run a submission in its folder of the site, and write its page."""
    name = create(submission.spec).name
    if name != submission.name:
        raise ValueError(f"the name of the submission is {submission.name}, but that of its model is {name}")
    target = prepare_folder(site / submission.folder)
    judged = [entry.submission.folder for entry in earlier if entry.submission and entry.judged]
    if judged and not (target / STORE).exists():
        # The values of the reference are the same for every submission.
        with rows_in(target) as store, rows_in(site / judged[-1]) as source:
            store.copy(source, lambda row: row.model == REFERENCE)
    run(models=[submission.spec], folder=target, jobs=jobs)
    write_page(make_page(read_folder(target)), target / REPORT)


def entry_of(folder: Path) -> Entry:
    """Return the results of a folder with the keys that its tables of errors are about, each with its references."""
    stored = read_folder(folder)
    inputs = stored_inputs(folder, stored.record)
    planned = {(task.key, grid.reference) for grid in inputs.cases.compared for task in plan([grid], inputs.models)}
    return Entry(stored, planned)
