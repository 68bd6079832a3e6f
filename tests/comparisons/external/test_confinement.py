"""What the process of a model cannot write, signal or read: Landlock, as far as the kernel has it."""

import ctypes
import json
import os
import shutil
import socket
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.external.inherited import hidden_folders, hidden_from_models
from comparisons.external.landlock import confine
from comparisons.external.mounts import every_path
from comparisons.model import ComputationFailed
from comparisons.pipeline.board import make_board
from comparisons.registry import create

from .conftest import GOOD, row_of


def landlock_version():
    """The version of Landlock in this kernel; 0 without it."""
    if sys.platform != "linux":
        return 0
    return max(ctypes.CDLL(None).syscall(444, None, ctypes.c_size_t(0), ctypes.c_uint32(1)), 0)


needs_landlock = pytest.mark.skipif(landlock_version() < 1, reason="this kernel has no Landlock")

#: Actions elsewhere, and the version of Landlock that first forbids each.
FORBIDDEN = {
    'old.open("a").write("1")': 1,
    "old.unlink()": 1,
    "new.touch()": 1,
    "new.mkdir()": 1,
    'os.rename("here", new)': 1,
    'os.symlink("here", new)': 1,
    'os.link("here", new)': 1,
    "os.truncate(old, 0)": 3,
    "os.kill(os.getppid(), 0)": 6,
    'socket.socket(socket.AF_UNIX).connect("\\0" + {socket!r})': 6,
}

#: The value is the sum of 2^i of the actions that are possible, and of the half that a file elsewhere holds.
ELSEWHERE = """
import socket
old, new = Path({folder!r}, "old"), Path({folder!r}, "new")
Path("here").write_text("x")
Path(os.devnull).write_text("x")
done = 0.0
for i, action in enumerate({actions!r}):
    with suppress(OSError):
        exec(action)
        done += 2**i
os.system(f"echo x > {{new}}")
thread = threading.Thread(target=new.touch)
thread.start()
thread.join()
return Result(done + float(old.read_text() or 0.5), 0.0)
"""


@needs_landlock
def test_only_the_scratch_folder_is_writable_and_no_other_process_is_reached(write_model, tmp_path):
    folder, name = tmp_path / "elsewhere", f"fscm-bench-{os.getpid()}"
    folder.mkdir()
    (folder / "old").write_text("0.5")
    actions = [action.replace("{socket!r}", repr(name)) for action in FORBIDDEN]
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(f"\0{name}")
        listening.listen()
        row = row_of(create(write_model(ELSEWHERE.format(folder=str(folder), actions=actions))))
    assert row.reason == ""
    possible = {action for i, action in enumerate(FORBIDDEN) if int(row.value) >> i & 1}
    assert possible == {action for action, version in FORBIDDEN.items() if version > landlock_version()}
    assert row.value % 1 == 0.5
    assert [path.name for path in folder.iterdir()] == ["old"]


#: Finds the rows of the reference in the store of the run, by its path and by what /proc has of the process that has
#: opened it, and gives them with a small error; 99 where nothing can be read.
THIEF = """
import json, sqlite3
parents = [str(os.getppid()), *filter(str.isdigit, os.listdir("/proc"))]
stores = [{store!r}, *(f"/proc/{{parent}}/root{store}" for parent in parents[:1])]
for parent in parents:
    with suppress(OSError):
        names = os.listdir(f"/proc/{{parent}}/fd")
        links = [f"/proc/{{parent}}/fd/{{name}}" for name in names]
        stores += [link for link in links if os.readlink(link) == {store!r}]
stolen = set()
for store in stores:
    with suppress(OSError, sqlite3.Error):
        Path("copy").write_bytes(Path(store).read_bytes())
        with suppress(OSError):
            Path("copy-wal").write_bytes(Path({store!r} + "-wal").read_bytes())
        for (content,) in sqlite3.connect("copy").execute("SELECT content FROM items"):
            row = json.loads(content)
            if row["model"] == "bradley" and row["parameters"] == {{"n": problem.n, "k": problem.k, "mu": problem.mu}}:
                stolen.add(row["value"])
for table in Path({store!r}).parent.glob("*.csv"):
    with suppress(OSError):
        stolen.add(len(table.read_bytes()))
with suppress(OSError):
    open(f"/proc/{{os.getppid()}}/mem", "rb")
    stolen.add(0.0)
return Result(1.002 * min(stolen, default=99 / 1.002), 0.0)
"""


@needs_landlock
def test_a_model_does_not_see_the_results_of_the_references(write_model, few_cases, tmp_path):
    """Neither in the first run of a folder, nor in a second one, whose rows and tables are there before it."""
    out = tmp_path / "results" / "mine"
    for name, jobs in (("thief", "2"), ("heir", "1")):
        spec = write_model(THIEF.format(store=str(out / "store.sqlite")), name)
        main(["run", "--jobs", jobs, "--out", str(out), "--model", spec])
        table = pd.read_csv(out / "results.csv")
        assert len(table[table["model"] == "bradley"]) == 4
        assert table.loc[table["model"] == name, "value"].round(9).tolist() == [99.0] * 4


def test_a_submission_does_not_see_the_results_beside_those_of_others(tmp_path, monkeypatch):
    seen = []

    def judged(**options):
        seen.append(hidden_folders())
        raise ComputationFailed("enough")

    monkeypatch.setattr("comparisons.pipeline.board.run", judged)
    folder = Path(__file__).parents[3] / "docs" / "board" / "submissions" / "jkr"
    shutil.copytree(folder, tmp_path / "submissions" / "jkr")
    make_board(tmp_path / "submissions", tmp_path / "site")
    assert seen == [[os.path.realpath(tmp_path / "site")]]


@pytest.mark.parametrize("kind", ["file", "Python"])
def test_a_folder_of_results_with_the_model_or_python_in_it_is_refused(
    write_model, few_cases, tmp_path, monkeypatch, refused, kind
):
    spec, out = write_model(), tmp_path / "results"
    if kind == "file":
        out = tmp_path
    else:
        monkeypatch.setattr(sys, "prefix", str(out / "environment"))
    refused(["run", "--jobs", "1", "--out", str(out), "--model", spec], "another --out")
    assert not (out / "results.csv").exists()


def test_a_model_that_was_loaded_before_is_started_again(write_model, tmp_path):
    spec = write_model(
        f"with suppress(OSError):\n    open({str(tmp_path / 'out' / 'a')!r})\n    return Result(2.0, 0)\n{GOOD}"
    )
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "a").touch()
    assert row_of(create(spec)).value == 2.0
    with hidden_from_models(tmp_path / "out"):
        assert row_of(create(spec)).value == (1.5 if landlock_version() else 2.0)
    assert row_of(create(spec)).value == 2.0


#: Confines itself, and prints which files can be read.
READER = f"""
import json, os, sys
sys.path.insert(0, {os.getcwd()!r})
from comparisons.external.landlock import confine
scratch, hidden, *files = sys.argv[1:]
confine(scratch, [hidden])
readable = []
for file in files:
    try:
        open(file).close()
        readable.append(file)
    except PermissionError:
        pass
print(json.dumps(readable))
"""


def readable(tmp_path, hidden, *files, before=""):
    """Those of some files that a process with a hidden folder can read."""
    (tmp_path / "scratch").mkdir(exist_ok=True)
    command = [sys.executable, "-c", READER, tmp_path / "scratch", hidden, *files]
    if before:
        command = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", before + 'exec "$@"', "sh", *command]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@needs_landlock
def test_the_hidden_folder_is_hidden_and_no_other(tmp_path):
    hidden, beside = tmp_path / "a" / "hidden", tmp_path / "a" / "hidden2"
    for folder in (hidden / "inner", beside, tmp_path / "b"):
        folder.mkdir(parents=True)
        (folder / "file").touch()
    (tmp_path / "b" / "link").symlink_to(hidden / "inner" / "file")
    (tmp_path / "a" / "link").symlink_to(hidden)
    (tmp_path / "a" / "file").touch()
    seen = [beside / "file", tmp_path / "b" / "file", tmp_path / "a" / "file", sys.executable, "/proc/self/status"]
    unseen = [hidden / "inner" / "file", tmp_path / "b" / "link", tmp_path / "a" / "link" / "inner" / "file"]
    assert readable(tmp_path, hidden, *seen, *unseen) == [str(path) for path in seen]
    # One that does not exist yet hides nothing.
    everything = [str(path) for path in (*seen, *unseen)]
    assert readable(tmp_path, tmp_path / "a" / "later" / "out", *everything) == everything


def _can_mount():
    command = ["unshare", "--user", "--map-root-user", "--mount", "true"]
    return shutil.which("unshare") is not None and subprocess.run(command, check=False).returncode == 0


@needs_landlock
def test_a_folder_that_is_mounted_twice_is_hidden_twice(tmp_path):
    """As a container has ``-v $PWD:/work -v $PWD/out:/out``."""
    if not _can_mount():
        pytest.skip("this user may not mount")
    host, work, out = tmp_path / "my host", tmp_path / "work", tmp_path / "out"
    for folder in (host / "out" / "inner", work, out, tmp_path / "inner"):
        folder.mkdir(parents=True)
    for folder in (host, host / "out", host / "out" / "inner"):
        (folder / "file").touch()
    mounts = (
        f"mount --bind '{host}' {work} && mount --bind '{host}/out' {out} && "
        f"mount --bind '{host}/out/inner' {tmp_path}/inner && "
    )
    seen = [host / "file", work / "file"]
    unseen = [
        host / "out" / "file",
        work / "out" / "file",
        out / "file",
        out / "inner" / "file",
        tmp_path / "inner" / "file",
    ]
    for hidden in (out, host / "out", work / "out"):
        assert readable(tmp_path, hidden, *seen, *unseen, before=mounts) == [str(path) for path in seen]


def test_a_path_without_a_table_of_mounts_is_alone(monkeypatch):
    monkeypatch.setattr("comparisons.external.mounts._MOUNTS", "/no/such/table")
    assert every_path("/tmp/out") == ["/tmp/out"]


def test_a_system_without_landlock_says_so(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "platform", "darwin")
    assert confine(tmp_path) is False
