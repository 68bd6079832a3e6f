"""The check of a pull request to the board: one model, and nothing of another one."""

import os
import shutil
import subprocess
import sys
from datetime import date
from pathlib import Path

import pytest
import yaml

from comparisons.pipeline.proposal import SUBMISSIONS, changes, checked_folder
from comparisons.pipeline.proposal import main as check
from tests.paths import ROOT

TODAY = date(2026, 11, 28)
WORDS = 'authors = ["{author}"]\ncitation = "none"\nlicence = "MIT"\nmodel = "model.py:Model"\n'


def git(clone, *arguments):
    identity = ("-c", "user.name=a", "-c", "user.email=a@b")
    subprocess.run(["git", "-C", clone, *identity, *arguments], check=True, capture_output=True)


def submission(clone, folder, name, version="1", author="A. Author", day="2026-01-01"):
    """Write a submission; return its folder."""
    path = clone / SUBMISSIONS / folder
    path.mkdir(parents=True, exist_ok=True)
    (path / "model.py").write_text(f"# {name} {version}, code of fifty characters that Git takes for moved\n")
    described = f'name = "{name}"\nversion = "{version}"\ndate = {day}\n{WORDS.format(author=author)}'
    (path / "submission.toml").write_text(described)
    return path


@pytest.fixture(scope="module")
def clones(tmp_path_factory):
    """A clone with the board, and one in which proposals are made."""
    folder = tmp_path_factory.mktemp("clones")
    for name in ("main", "proposed"):
        clone = folder / name
        submission(clone, "owner", "owner", day="2026-05-01")
        submission(clone, "versions/1.0", "versions", "1.0")
        submission(clone, "md-improved", "md-improved")
        (clone / "README.md").write_text("x")
        git(folder, "init", "-q", "-b", "board", name)
        git(clone, "add", "-A")
        git(clone, "commit", "-qm", "board")
    return folder / "main", folder / "proposed"


@pytest.fixture
def proposal(clones):
    """A function that makes a change in the clone, and checks it."""
    main, proposed = clones

    def checked(change, today=TODAY):
        git(proposed, "reset", "-q", "--hard", "board")
        git(proposed, "clean", "-qfdx")
        git(proposed, "checkout", "-q", "--detach", "board")
        change(proposed)
        git(proposed, "add", "-A")
        git(proposed, "commit", "-qm", "proposal", "--allow-empty")
        return checked_folder(changes(proposed), main, proposed, today)

    return checked


def moved(clone):
    """The model of another one, moved into an own folder: Git shows one rename."""
    submission(clone, "mine", "mine")
    (clone / SUBMISSIONS / "owner" / "model.py").rename(clone / SUBMISSIONS / "mine" / "model.py")


def several(clone):
    for name in ("mine", "other"):
        submission(clone, name, name)


def removed(clone):
    shutil.rmtree(clone / SUBMISSIONS / "owner")


def renamed_version(clone):
    (clone / SUBMISSIONS / "versions" / "1.0").rename(clone / SUBMISSIONS / "versions" / "2.0")
    submission(clone, "versions/2.0", "versions", "2.0")


def linked(clone):
    (submission(clone, "mine", "mine") / "data.csv").symlink_to("/etc/passwd")


def hidden(clone):
    (clone / SUBMISSIONS / "submission.toml").write_text("x")


def of_a_file(path):
    def written(clone):
        file = Path(os.fsdecode(os.fsencode(clone) + b"/" + path))
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("changed")

    return written


def of_submission(*arguments, **more):
    return lambda clone: submission(clone, *arguments, **more)


REFUSED = {
    "nothing": (lambda clone: None, "no file"),
    "several": (several, "mine, other"),
    "moves that of another": (moved, "mine, owner"),
    "removes": (removed, "the proposal removes owner"),
    "changes another": (
        lambda clone: moved(clone) or of_a_file(b"docs/board/submissions/owner/x")(clone),
        "mine, owner",
    ),
    "code": (of_a_file(b"README.md"), "README.md"),
    "hides": (hidden, "submission.toml"),
    "line end": (of_a_file(b"docs/board/submissions/mine/a\nb"), "not every system"),
    "bytes": (of_a_file(b"docs/board/submissions/mi\xffne/a"), "not every system"),
    "letters": (of_a_file("docs/board/submissions/mine/m\u043edel.py".encode()), "not every system"),
    "link": (linked, "120000"),
    "name of another": (of_submission("aaa", "owner", "2"), "the folder of the model owner is owner"),
    "name like another": (of_submission("0wner", "0wner"), "resembles owner"),
    "name like ours": (of_submission("md_improved", "md_improved"), "resembles"),
    "version of another": (of_submission("versions/1.1", "versions", "1.1", author="B. Thief"), "none of the authors"),
    "inside another": (of_submission("owner/2", "owner", "2", author="B. Thief"), "none of the authors"),
    "authors of another": (of_submission("owner", "owner", author="B. Thief"), "none of the authors"),
    "future": (of_submission("mine", "mine", day="9999-12-31"), "9999-12-31"),
    "future of an old one": (of_submission("owner", "owner", day="2026-11-29"), "2026-11-29"),
    "past": (of_submission("versions/1.1", "versions", "1.1", day="2025-12-31"), "2026-01-01"),
    "loses a version": (renamed_version, "1.0 of versions"),
    "beside the folders": (of_a_file(b"docs/board/submissions/notes.md"), "in no folder of a model"),
    "not described": (of_a_file(b"docs/board/submissions/mine/model.py"), "cannot be read"),
    "not admissible": (of_submission("mine", "mine", "1\\n"), "version"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_one_model_of_ones_own_is_refused(proposal, name):
    change, words = REFUSED[name]
    with pytest.raises(ValueError, match=words) as error:
        proposal(change)
    assert str(error.value).isprintable()
    assert len(str(error.value)) < 500


def moved_into_versions(clone):
    """The only version of a model, which gets a second one."""
    removed(clone)
    submission(clone, "owner/1", "owner", day="2026-05-01")
    submission(clone, "owner/2", "owner", "2", day="2026-11-28", author="a. author")


@pytest.mark.parametrize(
    ("change", "folder"),
    [
        (of_submission("mine", "mine", day="2026-11-28"), "mine"),
        (of_submission("versions/1.1", "versions", "1.1", day="2026-01-01"), "versions"),
        (of_submission("owner/2", "owner", "2", day="2026-05-02"), "owner"),
        (of_a_file(b"docs/board/submissions/owner/model.py"), "owner"),
        (moved_into_versions, "owner"),
    ],
)
def test_a_new_model_a_new_version_and_a_corrected_one_are_admissible(proposal, change, folder):
    assert proposal(change) == f"docs/board/submissions/{folder}"


def test_a_clone_without_a_parent_is_refused_in_one_sentence(clones, capsys):
    main, _ = clones
    with pytest.raises(ValueError, match="are not known"):
        changes(main)
    assert check([str(main), str(main / "no")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_the_workflow_calls_it(clones, proposal):
    """The step of the workflow, as it stands there."""
    text = (ROOT / ".github" / "workflows" / "board.yml").read_text(encoding="utf-8")
    steps = [step.get("run", "") for step in yaml.safe_load(text)["jobs"]["check"]["steps"]]
    (script,) = [script for script in steps if "proposal" in script]
    folder = clones[0].parent
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    for change, status in ((of_submission("mine", "mine"), 0), (linked, 2)):
        try:
            proposal(change)
        except ValueError:
            assert status == 2
        done = subprocess.run(["bash", "-e", "-c", script], cwd=folder, env=environment, capture_output=True, text=True)
        assert (done.returncode, done.stderr.count("\n")) == (status, bool(status))
        assert (folder / "changed").read_text() == ("" if status else "docs/board/submissions/mine\n")
