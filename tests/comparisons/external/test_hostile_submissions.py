"""Submissions that would harm the board: each costs itself one sentence, and the row of another one stays."""

import os
import shutil
from pathlib import Path

import pytest

from comparisons.pipeline import board as board_module
from comparisons.pipeline.submission import check_files, read_submission, submission_folders

from .board_pages import board, rows_of

#: Texts of a description, in place of one that is admissible, and words of the sentence that refuses them.
DESCRIPTIONS = {
    "long-model": ('model = "mine.py:Model"', f'model = "{"x" * 400}"', "at most 200"),
    "nul-character": ('version = "1"', 'version = "1\\u0000"', "version"),
    "line-end": ('version = "1"', 'version = "1.0\\n"', "version"),
    "bidi": ('citation = "none"', 'citation = "a\\u202Etxt.exe"', "citation"),
    "pile": ('citation = "none"', f'citation = "Z{chr(0x301) * 40}"', "citation"),
    "day": ("date = 2026-01-01", 'date = "9999-99-99"', "date"),
    "no-day": ("date = 2026-01-01", 'date = "2026-02-30"', "date"),
    "hour": ("date = 2026-01-01", "date = 2026-01-01T10:00:00", "date"),
    "bits": ("date = 2026-01-01", f"date = 0x{'f' * 9000}", "36000 bits"),
    "digits": ("date = 2026-01-01", f"date = {'9' * 9000}", "too many digits"),
    "dots": ("licence", f"licence{'.a' * 2_000}", "nested too deeply"),
    "quotes": ("licence", 'licence."a"' + " . 'a'" * 100, "nested too deeply"),
    "brackets": ("authors = [", f"authors = [{'[' * 5000}", "nested too deeply"),
    "names": ('authors = ["A. <b>Author</b>"]', f"authors = [{'1,' * 25_000}]", "authors"),
    "large": ("authors", f"# {'x' * 70_000}\nauthors", "more than 60000"),
    "table": ('licence = "MIT"', "licence = {a = 1}", "licence"),
    "program": ('model = "mine.py:Model"', 'model = "../../bin/sh"', "model"),
    "parent": ('model = "mine.py:Model"', 'model = "a/../../owner/mine.py:Model"', "leads out"),
    "folder": ('model = "mine.py:Model"', 'model = "a/b"', "no file beside it"),
}

#: What is made in the folder of a submission, and words of the sentence that refuses it.
FILES = {
    "link": (lambda folder: (folder / "passwd").symlink_to("/etc/passwd"), "passwd"),
    "loop": (lambda folder: (folder / "loop").symlink_to("loop"), "loop"),
    "pipe": (lambda folder: os.mkfifo(folder / "pipe"), "pipe"),
    "sparse": (lambda folder: _sized(folder / "sparse.bin", 2**40), "20000000 bytes"),
    "many": (lambda folder: [(folder / f"{number}.dat").touch() for number in range(500)], "500|more than 400"),
    "deep": (lambda folder: (folder / "/".join(["abcdefghi"] * 30)).mkdir(parents=True), "at most 200 characters"),
    "capitals": (lambda folder: [(folder / name).touch() for name in ("table.csv", "Table.csv")], "capitals"),
    "device": (lambda folder: (folder / "aux.csv").touch(), "aux.csv"),
    "space": (lambda folder: (folder / "a table.csv").touch(), "a table.csv"),
    "lines": (lambda folder: (folder / "a\nb").touch(), "not every system"),
    "bytes": (lambda folder: open(os.fsencode(folder) + b"/\xff", "wb").close(), "udcff"),
    "described-by-a-link": (lambda folder: _linked(folder / "submission.toml"), "submission.toml"),
    "described-by-a-pipe": (lambda folder: _piped(folder / "submission.toml"), "submission.toml"),
    "described-by-a-folder": (lambda folder: _piped(folder / "submission.toml", Path.mkdir), "submission.toml"),
}


def _sized(file, size):
    with file.open("wb") as opened:
        opened.truncate(size)


def _linked(file):
    file.unlink()
    file.symlink_to("/dev/zero")


def _piped(file, make=os.mkfifo):
    file.unlink()
    make(file)


def test_each_costs_itself_one_sentence_and_no_other_row_changes(submissions, tmp_path, monkeypatch, capsys):
    owner = submissions("ten-percent", name="ten-percent", model="ten-percent")
    _, page = board(tmp_path)
    (row,), named = rows_of(page, "models"), {}
    for name, (old, new, words) in DESCRIPTIONS.items():
        manifest = submissions(name, name=name)
        assert old in manifest.read_text()
        manifest.write_text(manifest.read_text().replace(old, new))
        named[name] = words
    for name, (make, words) in FILES.items():
        make(submissions(name, name=name).parent)
        named[name] = words
    # The owner's name in folders that sort before and after its own, as another version, and a name that resembles it.
    for folder, version in (("a", "1"), ("z", "2"), ("0/1", "3")):
        submissions(folder, name="ten-percent", version=version, model="ten-percent", date="2026-12-31")
        named[folder] = "the folder of the model ten-percent is ten-percent"
    submissions("ten_percent", name="ten_percent", date="2026-12-31")
    submissions("Upper", name="Upper")
    named |= {"ten_percent": "resembles", "Upper": "small letters"}
    # Descriptions above and below those of others, a folder that is a link, and names of folders.
    shutil.copy(owner, tmp_path / "submissions" / "submission.toml")
    submissions("hides/1", name="hides", model="no-such-model")
    shutil.copy(owner, tmp_path / "submissions" / "hides" / "submission.toml")
    os.mkfifo(submissions("ten-percent/inside", name="inside").parent / "pipe")
    _piped(submissions("ten-percent/pipe", name="ten-percent", version="4"))
    (tmp_path / "submissions" / "linked").symlink_to(owner.parent)
    os.mkdir(os.fsencode(tmp_path / "submissions") + b"/bytes\xff")
    named |= {
        "submissions": "not every system can hold",
        "hides": "the folder of the model ten-percent is ten-percent, and this one is hides",
        "hides/1": "no-such-model",
        "ten-percent/inside": "pipe",
        "ten-percent/pipe": "submission.toml",
    }
    named |= {"linked": "symbolic link", "bytes\\udcff": "not every system"}
    # What no rule is about.
    submissions("odd", name="odd", model="odd.py:Model").parent.joinpath("odd.py").touch()
    named["odd"] = "it cannot be judged (OverflowError: too large"
    real = board_module._judge

    def judge(submission, *more):
        if submission.name == "odd":
            raise OverflowError("too large\x1b[2K")
        real(submission, *more)

    monkeypatch.setattr(board_module, "_judge", judge)
    capsys.readouterr()
    status, page = board(tmp_path)
    assert status == 4
    assert rows_of(page, "models") == [row]
    reasons = {cells[0]: cells[3] for cells in rows_of(page, "submissions") if cells[2] == "not judged"}
    assert reasons.keys() == named.keys()
    unlike = [(name, reasons[name]) for name, words in named.items() if not _has(reasons[name], words)]
    assert unlike == []
    assert all(reason.isprintable() and len(reason) < 700 for reason in reasons.values())
    for hidden in ("\u202e", "\u0301", "\x1b"):
        assert hidden not in page
    assert capsys.readouterr().err.isascii()


def _has(reason, words):
    return any(word in reason for word in words.split("|"))


def test_a_folder_of_a_model_and_its_versions_are_found_from_every_level(submissions, tmp_path):
    for version in ("1.0", "1.1"):
        submissions(f"mine/{version}", version=version)
    submissions("other", name="other")
    root = tmp_path / "submissions"
    assert [folder.path for folder in submission_folders(root)] == ["mine/1.0", "mine/1.1", "other"]
    assert [folder.path for folder in submission_folders(root / "mine")] == ["1.0", "1.1"]
    assert [folder.path for folder in submission_folders(root / "other")] == ["other"]
    assert not any(folder.flaw for folder in submission_folders(root))


def test_a_description_above_those_of_versions_is_one_more_version(submissions, tmp_path):
    for folder, version in (("mine", "1.0"), ("mine/1.1", "1.1")):
        submissions(folder, version=version)
    root = tmp_path / "submissions"
    for start in (root, root / "mine"):
        read = [read_submission(folder) for folder in submission_folders(start)]
        assert [(entry.name, entry.version) for entry in read] == [("mine", "1.0"), ("mine", "1.1")]


def test_a_description_above_those_of_others_hides_none(submissions, tmp_path):
    owner, root = submissions("owner", name="owner"), tmp_path / "submissions"
    shutil.copy(owner, root / "submission.toml")
    stray, found = submission_folders(root)
    assert read_submission(found).name == "owner"
    with pytest.raises(ValueError, match="this one is submissions"):
        read_submission(stray)


def test_the_name_of_the_root_belongs_to_the_folder_that_has_it(submissions, tmp_path):
    for folder in ("aaa", "submissions"):
        submissions(folder, name="submissions")
    thief, owner = submission_folders(tmp_path / "submissions")
    assert read_submission(owner).name == "submissions"
    with pytest.raises(ValueError, match="this one is aaa"):
        read_submission(thief)


def test_an_ordinary_folder_is_admissible(submissions):
    folder = submissions("mine").parent
    (folder / "data" / "more").mkdir(parents=True)
    for name in ("data/table.csv", "data/more/__init__.py", ".gitignore", "README.md"):
        (folder / name).touch()
    check_files(folder)
    (folder / "data" / "NUL").touch()
    with pytest.raises(ValueError, match="NUL"):
        check_files(folder)
