"""Sweeps that are killed: one command completes the same tables."""

import json
import random
import subprocess
import sys
import time
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.data.file_names import STORE
from comparisons.runs.store import rows_in
from tests.comparisons.grid_text import grid_text

#: Closed forms that take milliseconds each: there is time to kill something.
GRID = grid_text(
    ["jkr", "md-original"],
    "md-improved",
    ["pull_off_force", "jump_out_displacement"],
    n=[1, 1.5, 2],
    k=[0, 0.4],
    mu=[0.5, 1, 2, 3],
)
ROWS = 3 * 2 * 24
TABLES = ("results.csv", "kappa.csv", "largest_kappa.csv", "curves.csv", "grid.toml")

#: Bytes of the log of the store when all rows are in it, about.
LOG = 1_500_000

#: Moments are chosen by this seed.
SEED = 20261122

needs_proc = pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="the system has no /proc")


@pytest.fixture(scope="module")
def grid(tmp_path_factory):
    path = tmp_path_factory.mktemp("sweep") / "mine.toml"
    path.write_text(GRID)
    return path


def sweep(grid, out):
    return main(["sweep", str(grid), "--jobs", "1", "--out", str(out), "--quiet"])


@pytest.fixture(scope="module")
def undisturbed(grid):
    assert sweep(grid, grid.parent / "undisturbed") == 0
    return tables(grid.parent / "undisturbed")


def tables(folder):
    return {name: (folder / name).read_bytes() for name in TABLES}


def rows(folder):
    """The stored rows, by key."""
    with rows_in(folder) as store:
        return {row.key: row for row in store.items}


def start(grid, out):
    command = [sys.executable, "-m", "comparisons", "sweep", str(grid), "--jobs", "2", "--out", str(out), "--quiet"]
    return subprocess.Popen(command)


def workers(process):
    """The worker processes of a command."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return [int(child) for child in children if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()]


def wait_for(process, out, share):
    """Wait until the log of the store, which only grows, has a share of its bytes; return whether the command runs."""
    log = out / f"{STORE}-wal"
    while process.poll() is None and (not log.exists() or log.stat().st_size < share * LOG):
        time.sleep(0.002)
    return process.poll() is None


def complete(grid, out, undisturbed):
    """Complete the tables by one command; they are the same, and what was stored is."""
    before = rows(out)
    assert sweep(grid, out) == 0
    after = rows(out)
    assert len(after) == ROWS
    assert {key: after[key] for key in before} == before
    assert tables(out) == undisturbed
    record = json.loads((out / "run.json").read_text())
    assert sum(segment["computations"] for segment in record["parts"]) == ROWS


@needs_proc
@pytest.mark.parametrize("kills", [1, pytest.param(10, marks=pytest.mark.heavy)])
def test_the_command_is_killed(grid, undisturbed, tmp_path, kills):
    rng = random.Random(SEED)
    stored = 0
    for end in (rng.random() for _ in range(kills)):
        with start(grid, tmp_path) as process:
            if wait_for(process, tmp_path, end):
                children = workers(process)
                process.kill()
                process.wait()
                # The workers end with their parent, and hold the lock no longer.
                for child in children:
                    while Path(f"/proc/{child}").exists():
                        time.sleep(0.01)
        stored, before = len(rows(tmp_path)), stored
        assert stored >= max(before, 1)
    complete(grid, tmp_path, undisturbed)
