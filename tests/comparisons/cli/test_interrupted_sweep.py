"""Sweeps that are killed, that fill the disk, or whose journal is damaged: one command completes the same tables."""

import errno
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.runs.store import Store

#: Closed forms that take milliseconds each: there is time to kill something.
GRID = """
[[grid]]
id = "mine"
title = "Mine"
reference = "md-improved"
models = ["jkr", "md-original"]
quantities = ["pull_off_force", "jump_out_displacement"]
n = [1, 1.5, 2]
k = [0, 0.4]
mu = [0.5, 1, 2, 3]
"""
ROWS = 3 * 2 * 24
TABLES = ("results.csv", "kappa.csv", "largest_kappa.csv", "curves.csv", "grid.toml")

#: Moments are chosen by this seed.
SEED = 20261122

needs_proc = pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="the system has no /proc")


@pytest.fixture(scope="module")
def grid(tmp_path_factory):
    path = tmp_path_factory.mktemp("sweep") / "mine.toml"
    path.write_text(GRID)
    return path


@pytest.fixture(scope="module")
def undisturbed(grid):
    out = grid.parent / "undisturbed"
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(out), "--quiet"]) == 0
    return tables(out)


def tables(folder):
    return {name: (folder / name).read_bytes() for name in TABLES}


def lines(folder):
    """The finished lines of the journal."""
    path = folder / "journal.jsonl"
    return path.read_bytes().split(b"\n")[:-1] if path.exists() else []


def start(grid, out):
    command = [sys.executable, "-m", "comparisons", "sweep", str(grid), "--jobs", "2", "--out", str(out), "--quiet"]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def workers(process):
    """The worker processes of a command."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return [int(child) for child in children if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()]


def wait_for(process, out, count):
    """Wait until the journal has so many lines; return whether the command is still running."""
    while process.poll() is None and len(lines(out)) < count:
        time.sleep(0.002)
    return process.poll() is None


def complete(grid, out, undisturbed):
    """Complete the tables by one command; they are the same, and no task is in the journal twice."""
    before = lines(out)
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(out), "--quiet"]) == 0
    after = lines(out)
    assert after[: len(before)] == before
    entries = [json.loads(line)["entry"]["item"] for line in after[1:]]
    keys = [(entry["model"], entry["quantity"], *entry["parameters"].values()) for entry in entries]
    assert len(set(keys)) == len(keys) == ROWS
    assert tables(out) == undisturbed
    record = json.loads((out / "run.json").read_text())
    assert sum(part["computations"] for part in record["parts"]) == ROWS


@needs_proc
@pytest.mark.parametrize("kills", [1, pytest.param(10, marks=pytest.mark.heavy)])
def test_the_command_is_killed(grid, undisturbed, tmp_path, kills):
    chosen = random.Random(SEED)
    ends = sorted(chosen.randrange(1, ROWS) for _ in range(kills))
    for end in ends:
        before = lines(tmp_path)
        with start(grid, tmp_path) as process:
            if wait_for(process, tmp_path, end):
                children = workers(process)
                process.kill()
                process.wait()
                # The workers end with their parent, and hold the lock no longer.
                for child in children:
                    while Path(f"/proc/{child}").exists():
                        time.sleep(0.01)
        assert lines(tmp_path)[: len(before)] == before
    complete(grid, tmp_path, undisturbed)


@needs_proc
@pytest.mark.heavy
@pytest.mark.parametrize("kills", [1, 10])
def test_workers_are_killed(grid, undisturbed, tmp_path, kills):
    chosen = random.Random(SEED)
    killed = 0
    with start(grid, tmp_path) as process:
        for end in sorted(chosen.randrange(1, ROWS - 20) for _ in range(kills)):
            if wait_for(process, tmp_path, end) and (children := workers(process)):
                os.kill(chosen.choice(children), signal.SIGKILL)
                killed += 1
        _, message = process.communicate()
    assert killed > 0
    # A task that was killed twice has failed, and the next command computes it again.
    assert process.returncode == (4 if "ended twice" in message else 0)
    if process.returncode == 0:
        assert tables(tmp_path) == undisturbed
        complete(grid, tmp_path, undisturbed)
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(tmp_path), "--quiet"]) == 0
    assert tables(tmp_path) == undisturbed


def test_a_task_whose_process_ended_twice_is_computed_by_the_next_command(grid, undisturbed, tmp_path, monkeypatch):
    def backend(function, items, jobs):
        for number, item in enumerate(items):
            yield item, None if number in (3, 0) else function(item)

    with monkeypatch.context() as patch:
        patch.setattr("comparisons.pipeline.run.backend_of", lambda *_: backend)
        assert main(["sweep", str(grid), "--jobs", "1", "--out", str(tmp_path), "--quiet"]) == 4
    assert tables(tmp_path) != undisturbed
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(tmp_path), "--quiet"]) == 0
    assert tables(tmp_path) == undisturbed


@pytest.mark.parametrize("room", [pytest.param(0, marks=pytest.mark.heavy), 5000])
def test_the_disk_is_full_while_a_row_is_written(grid, undisturbed, tmp_path, monkeypatch, capsys, room):
    """A line of the journal is written in part."""

    def append(journal, line):
        size = journal.path.stat().st_size if journal.path.exists() else 0
        with journal.path.open("a", encoding="utf-8") as file:
            file.write(line[: max(0, room - size)])
        if size + len(line) > room:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(journal.path))

    with monkeypatch.context() as patch:
        patch.setattr(Store, "_append", append)
        assert main(["sweep", str(grid), "--jobs", "1", "--out", str(tmp_path), "--quiet"]) == 4
    message = capsys.readouterr().err
    assert "No space left on device" in message
    assert message.count("\n") == 1
    complete_after_a_torn_line(grid, tmp_path, undisturbed)


def complete_after_a_torn_line(grid, out, undisturbed):
    before = lines(out)
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(out), "--quiet"]) == 0
    assert lines(out)[: len(before)] == before
    assert len(lines(out)) == ROWS + 1
    assert tables(out) == undisturbed


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 32 kB, and a function that makes it larger."""
    folder = tmp_path / "disk"
    folder.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=32k", "tmpfs", folder], capture_output=True).returncode:
        pytest.skip("file systems can be mounted by root alone")
    try:
        yield folder, lambda: subprocess.run(["mount", "-o", "remount,size=8m", folder], check=True)
    finally:
        subprocess.run(["umount", folder], check=True)


def test_a_small_disk_is_full(grid, undisturbed, small_disk, capsys):
    out, enlarge = small_disk
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(out), "--quiet"]) == 4
    assert "No space left on device" in capsys.readouterr().err
    assert 10 < len(lines(out)) < ROWS
    enlarge()
    complete_after_a_torn_line(grid, out, undisturbed)


@pytest.mark.parametrize("damages", [2, pytest.param(30, marks=pytest.mark.heavy)])
def test_a_damaged_journal(grid, undisturbed, tmp_path, damages):
    """Truncated anywhere, or a bit of it flipped, again and again."""
    chosen = random.Random(SEED)
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(tmp_path), "--quiet"]) == 0
    journal = tmp_path / "journal.jsonl"
    for number in range(damages):
        content = bytearray(journal.read_bytes())
        if number % 3 == 0:
            del content[chosen.randrange(1000, len(content)) :]
        else:
            content[chosen.randrange(len(content))] ^= 1 << chosen.randrange(8)
        journal.write_bytes(content)
        assert main(["sweep", str(grid), "--jobs", "1", "--out", str(tmp_path), "--quiet"]) == 0
        assert tables(tmp_path) == undisturbed
        assert len(lines(tmp_path)) == ROWS + 1
