"""The board, a static site of submissions that are run and judged, and the leaderboard of runs.

A submission is a folder with a ``submission.toml`` beside the files of a model.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from datetime import date
from pathlib import Path
from typing import Any

from comparisons.console.progress import log, note
from comparisons.data.contained_paths import path_inside
from comparisons.data.file_names import REPORT, STORE
from comparisons.data.input_files import read_text
from comparisons.data.toml_text import parse
from comparisons.data.validation import validated
from comparisons.external.model_source import close_models
from comparisons.model import ComputationFailed
from comparisons.output.report.board import BoardEntry, Submission, board_page
from comparisons.output.report.leaderboard import Entry, leaderboard_html
from comparisons.output.report.page import make_page
from comparisons.output.report.render import render
from comparisons.output.report.stored_run import read_folder
from comparisons.pipeline.inputs import stored_inputs
from comparisons.pipeline.run import run
from comparisons.pipeline.tables import REFERENCE
from comparisons.registry import MODELS, create
from comparisons.runs.atomic_files import prepare_folder, write_file
from comparisons.runs.environment import fingerprint
from comparisons.runs.store import rows_in
from comparisons.runs.tasks import plan

#: Describes a submission.
MANIFEST = "submission.toml"


def submission_folders(root: Path) -> Iterator[Path]:
    """Yield the folders of submissions: `root` if it is one, else each folder in it, or the versions in that.

    Raises
    ------
    ValueError
        If there is none.
    """
    if (root / MANIFEST).is_file():
        yield root
        return
    folders = _folders_in(root) if root.is_dir() else []
    if not folders:
        raise ValueError(f"{root} has no folder with a {MANIFEST}: a board is made of submissions")
    for folder in folders:
        versions = [] if (folder / MANIFEST).is_file() else _folders_in(folder)
        yield from versions or [folder]


def _folders_in(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.is_dir() and not path.is_symlink() and path.name[0] != ".")


def read_submission(folder: Path) -> Submission:
    """Read the description of a submission; the model is not loaded.

    Raises
    ------
    ValueError
        If it cannot be read or is not admissible; one sentence says why.
    """
    path = path_inside(folder, MANIFEST)
    described: dict[str, Any] = parse(read_text(path, "the description of the submission"), MANIFEST)
    if isinstance(described.get("date"), date):
        described["date"] = described["date"].isoformat()
    validated(described, "submission", MANIFEST)
    authors, model = tuple(described.pop("authors")), described.pop("model")
    return Submission(**described, authors=authors, spec=_spec(folder, model))


def _spec(folder: Path, model: str) -> str:
    """Return the SPEC of a registered model, or of a file in the folder; nothing else that is installed is run."""
    if model in MODELS:
        return model
    name, colon, attribute = model.rpartition(":") if ".py:" in model else (model, "", "")
    path = path_inside(folder, name)
    if not path.is_file():
        raise ValueError(f"{MANIFEST}: model = {model!a:.80} is not a model of fscm-bench, and no file beside it")
    # With a separator it is not a name of an installed model.
    return f"{path if path.is_absolute() else f'./{path}'}{colon}{attribute}"


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
        If there is no submission, or `site` holds files that are not of a board.
    OSError
        If a file cannot be written.
    """
    folders = list(submission_folders(submissions))
    _prepare(site)
    entries: list[BoardEntry] = []
    for folder in folders:
        note(f"submission {folder}")
        entries.append(_entry(folder, submissions, site, entries, jobs))
        # Each model is a process, which is not needed any more.
        close_models()
    write_file(site / INDEX, render(board_page(entries)))
    return entries


def _prepare(site: Path) -> None:
    """Make the folder of a site; results of other code are removed."""
    prepare_folder(site)
    code = site / _CODE
    if not code.exists() and any(site.iterdir()):
        raise ValueError(f"{site} holds files that are not of a board; choose another folder with --out")
    if not code.exists() or code.read_text(encoding="utf-8") != fingerprint():
        shutil.rmtree(site / "models", ignore_errors=True)
        write_file(code, fingerprint())


def _entry(folder: Path, root: Path, site: Path, earlier: list[BoardEntry], jobs: int) -> BoardEntry:
    """Return a submission with its results, or with the reason why it has none."""
    path = folder.relative_to(root).as_posix() if folder != root else folder.name
    submission = None
    try:
        submission = read_submission(folder)
        if submission.folder in [entry.submission.folder for entry in earlier if entry.submission]:
            raise ValueError(f"{submission.name} {submission.version} is there twice: each needs its own version")
        _judge(submission, site, earlier, jobs)
        judged = entry_of(site / submission.folder)
    except (ValueError, ComputationFailed) as error:
        log(f"{path} is not judged: {error}")
        return BoardEntry(path, submission, None, str(error))
    return BoardEntry(path, submission, judged)


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
            store.take(source, lambda row: row.model == REFERENCE)
    run(models=[submission.spec], folder=target, jobs=jobs)
    write_file(target / REPORT, render(make_page(read_folder(target))))


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
    """Return the results of a folder with the keys that its tables of errors are about, each with its references."""
    stored = read_folder(folder)
    if shard := stored.record["arguments"].get("shard"):
        raise ValueError(f"{folder} is the part {shard} of a sweep: put the parts together with fscm-bench merge first")
    inputs = stored_inputs(folder, stored.record)
    if inputs.cases.sha256 != stored.record["cases_sha256"]:
        log(f"the standing cases have changed since {folder} was computed: its coverage counts every stored result")
        return Entry(str(folder), stored, None)
    planned = {(task.key, grid.reference) for grid in inputs.cases.compared for task in plan([grid], inputs.models)}
    return Entry(str(folder), stored, planned)
