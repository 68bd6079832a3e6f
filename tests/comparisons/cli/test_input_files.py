"""Input files that are no regular files, or too large: one sentence for every command that reads one."""

import os
from pathlib import PureWindowsPath

import pytest

from comparisons.cli.main import main
from comparisons.data import contained_paths
from comparisons.data.contained_paths import path_inside
from comparisons.data.input_files import LARGEST_TEXT, read_bytes, read_text
from tests.comparisons.grid_text import grid_text

GRID = grid_text(["jkr"], n=[2], k=[0], mu=[1])

#: Commands that read a file of the user, which takes the place of FILE.
COMMANDS = [
    "describe FILE",
    "describe --problem FILE",
    "solve --model jkr --quantity pull_off_force --problem FILE",
    "curve --model jkr --problem FILE",
    "sweep FILE --out out --jobs 1",
    "sweep --problem FILE --vary punch.R=1um --out out --jobs 1",
    "run --gates FILE --out out --jobs 1",
    "compare jkr --grid FILE --out out --jobs 1",
    "judge SWEPT --gates FILE",
]


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """The folder of a finished sweep."""
    folder = tmp_path_factory.mktemp("swept")
    (folder / "grid.toml").write_text(GRID)
    assert main(["sweep", str(folder / "grid.toml"), "--out", str(folder / "out"), "--jobs", "1", "--quiet"]) == 0
    return folder / "out"


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_refuses_a_device_in_one_sentence(command, swept, tmp_path, monkeypatch, refused):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "input.toml"
    file.symlink_to("/dev/null")
    refused(command.replace("FILE", str(file)).replace("SWEPT", str(swept)).split(), f"{file} is a device")
    assert not (tmp_path / "out").exists()


def test_a_pipe_is_not_waited_for(tmp_path):
    """No program writes into it."""
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(ValueError, match="is a pipe"):
        read_text(tmp_path / "pipe.toml", "the sweep file")


def test_a_folder_and_a_file_that_is_too_large(tmp_path):
    (tmp_path / "a").write_bytes(b"12345")
    assert read_bytes(tmp_path / "a", 5) == b"12345"
    with pytest.raises(ValueError, match="5 bytes, more than 4"):
        read_bytes(tmp_path / "a", 4)
    with (tmp_path / "a").open("wb") as large:
        large.truncate(LARGEST_TEXT + 7)
    with pytest.raises(ValueError, match=f"{LARGEST_TEXT + 7} bytes"):
        read_text(tmp_path / "a", "the file")
    with pytest.raises(ValueError, match=r"cannot be read .*directory"):
        read_text(tmp_path, "the file")


def test_paths_in_a_folder_and_paths_that_lead_out(tmp_path):
    folder = tmp_path / "folder"
    (folder / "b").mkdir(parents=True)
    (folder / "out").symlink_to(tmp_path / "a")
    (folder / "b" / "up").symlink_to("../..")
    (folder / "loop").symlink_to("../loop")
    (folder / "c").symlink_to("b/d")
    (tmp_path / "link").symlink_to("folder")
    outside = ["../a", "/etc/hostname", "b/../../a", "b/../a", "out", "loop", "b/up/a", ".."]
    for name in (*outside, "a\0b", str(folder / "a")):
        with pytest.raises(ValueError, match="leads out of the folder"):
            path_inside(folder, name)
    for name in ("a", "b/d", "./b//d", "c"):
        assert path_inside(tmp_path / "link", name) == tmp_path / "link" / name


def test_a_drive_of_windows_leads_out(tmp_path, monkeypatch):
    monkeypatch.setattr(contained_paths, "PurePath", PureWindowsPath)
    for name in ("D:pad.toml", "C:\\pad.toml", "..\\pad.toml"):
        with pytest.raises(ValueError, match="leads out of the folder"):
            path_inside(tmp_path, name)


@pytest.mark.parametrize("mark", ["", "\ufeff"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_marks_and_ends_of_lines_of_other_systems(mark, end, tmp_path):
    (tmp_path / "a").write_bytes(f"{mark}one{end}two µm{end}".encode())
    assert read_text(tmp_path / "a", "the file") == "one\ntwo µm\n"
