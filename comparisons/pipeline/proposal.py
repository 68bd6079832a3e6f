"""Check of a proposal to the board, a pull request: it changes the folder of one model, and nothing of another one.

``python -P -m comparisons.pipeline.proposal MAIN PROPOSED`` compares the commit of the clone PROPOSED with its first
parent, and what it proposes with the board of the clone MAIN.  It prints the folder; no code of either clone runs.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from datetime import UTC, date, datetime
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from comparisons.console.exit_status import OK, guarded
from comparisons.external.text_rules import appearance, is_portable
from comparisons.output.report.board_page import Submission
from comparisons.pipeline.submission import SubmissionFolder, read_submission, submission_folders

#: The folder of all submissions in the repository.
SUBMISSIONS = PurePosixPath("docs", "board", "submissions")

#: Modes of files in Git: a regular file, a program, and none where a file was removed.
_MODES = ("100644", "100755", "000000")


class Change(NamedTuple):
    """A file that a commit adds, changes or removes; a file that it moves is removed and added."""

    path: str
    mode: str


def changes(repository: Path) -> list[Change]:
    """Return what the last commit of a clone changes against its first parent.

    Raises
    ------
    ValueError
        If Git cannot tell.
    """
    command = ["git", "-C", os.fspath(repository), "diff-tree", "-r", "-z", "--raw", "--no-renames", "HEAD^1", "HEAD"]
    done = subprocess.run(command, capture_output=True, check=False)
    if done.returncode != 0:
        reason = " ".join(done.stderr.decode(errors="replace").split())
        raise ValueError(f"the changes of {repository} are not known: {reason[:200]}")
    facts, paths = (done.stdout.split(b"\0")[:-1][first::2] for first in (0, 1))
    return [Change(os.fsdecode(path), fact.split()[1].decode()) for fact, path in zip(facts, paths, strict=True)]


def checked_folder(changed: Iterable[Change], main: Path, proposed: Path, today: date) -> str:
    """Return the folder of the model that is proposed, relative to the clones.

    Parameters
    ----------
    changed : iterable of Change
    main, proposed : Path
        The clone with the board, and the one with the proposal.
    today : date
        No submission is of a later day, since the newest one of a model stands in the first table.

    Raises
    ------
    ValueError
        One sentence, if more than the folder of one model is changed, a version would be lost, or it is not admissible
        beside those on the board.
    """
    name = _one_folder(changed)
    on_board, new = list(_on_board(main, name)), [read_submission(folder) for folder in _folders(proposed, name)]
    if not new:
        raise ValueError(f"the proposal removes {name}, or it has no submission.toml: a maintainer removes a model")
    if lost := {entry.version for entry in on_board} - {entry.version for entry in new}:
        raise ValueError(f"the version {min(lost)} of {name} is on the board, and the proposal removes or renames it")
    names = [path.name for path in (main / SUBMISSIONS).iterdir() if path.name != name]
    if alike := [other for other in names if appearance(other) == appearance(name)]:
        raise ValueError(f"the name {name} resembles {alike[0]}, which is on the board; choose another name")
    authors = {author.casefold() for entry in on_board for author in entry.authors}
    versions = {entry.version for entry in on_board}
    newest = max((entry.date for entry in on_board), default="")
    for entry in new:
        if authors and authors.isdisjoint(author.casefold() for author in entry.authors):
            raise ValueError(
                f"{name} {entry.version} has none of the authors of {name} on the board: choose another name"
            )
        earliest = "" if entry.version in versions else newest
        if not earliest <= entry.date <= today.isoformat():
            since = f"between {earliest}, that of the newest version on the board, and" if earliest else "up to"
            raise ValueError(f"the date of {name} {entry.version}, {entry.date}, is not {since} today, {today}")
    return (SUBMISSIONS / name).as_posix()


def _one_folder(changed: Iterable[Change]) -> str:
    """Return the name of the only folder of a model that is changed."""
    names = set[str]()
    for path, mode in changed:
        parts = PurePosixPath(path).parts
        start, own = parts[: len(SUBMISSIONS.parts)], parts[len(SUBMISSIONS.parts) :]
        if start != SUBMISSIONS.parts or len(own) < 2:
            raise ValueError(
                f"{path!a:.200} is in no folder of a model in {SUBMISSIONS}: a proposal has one model alone"
            )
        if not all(map(is_portable, own)):
            raise ValueError(f"{path!a:.200} has a name that not every system can hold: use letters, digits, . _ and -")
        if mode not in _MODES:
            raise ValueError(f"{path!a:.200} is no regular file, but of the mode {mode} of Git: a link or a module")
        names.add(own[0])
    if len(names) != 1:
        listed = f"those of {', '.join(sorted(names)[:5])}" if names else "no file"
        raise ValueError(f"a proposal changes the folder of one model alone, and this one {listed}")
    return names.pop()


def _folders(clone: Path, name: str) -> list[SubmissionFolder]:
    """Return the folders of the submissions in the folder of a model."""
    root = clone / SUBMISSIONS
    return [folder for folder in submission_folders(root) if folder.path.split("/")[0] == name]


def _on_board(clone: Path, name: str) -> Iterator[Submission]:
    """Yield the submissions of a model that are on the board: one that cannot be read is not."""
    for folder in _folders(clone, name):
        with suppress(ValueError):
            yield read_submission(folder)


def main(arguments: Sequence[str] | None = None) -> int:
    """Check and print; return the exit status, 2 if the proposal is refused."""
    clones = sys.argv[1:] if arguments is None else arguments

    def check() -> int:
        board, proposed = map(Path, clones)
        print(checked_folder(changes(proposed), board, proposed, datetime.now(UTC).date()))
        return OK

    return guarded(check, "proposal")


if __name__ == "__main__":
    sys.exit(main())
