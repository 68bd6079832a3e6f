"""The Dask backend: the same bytes as processes, workers that end, addresses, threads of a worker."""

import builtins
import json
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.runs.workers import backend_of

pytest.importorskip("distributed")

GRID = """
[[grid]]
id = "mine"
title = "Mine"
reference = "md-improved"
models = ["jkr", "md-original"]
quantities = ["pull_off_force", "jump_out_displacement"]
n = [1, 2]
k = [0, 0.4]
mu = [1, 3]

[[grid]]
id = "curves"
title = "Curves"
reference = "jkr"
models = ["bradley"]
quantities = ["force_curve"]
n = [2]
k = [0]
mu = [1]
"""
TABLES = ("results.csv", "kappa.csv", "curves.csv")

ITEMS = """
import os, signal
from pathlib import Path

def work(item):
    import scipy.linalg, threadpoolctl
    name, folder = item
    path = Path(folder, name)
    if name == "always" or (name == "once" and not path.exists()):
        path.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return name, sorted({library["num_threads"] for library in threadpoolctl.threadpool_info()})

def lost(item):
    return item[0], "lost"
"""
CALLER = """
import sys
from comparisons.runs.workers import backend_of, each
from items import lost, work

if __name__ == "__main__":
    items = [(name, sys.argv[1]) for name in ("a", "once", "b", "always", "c", "d")]
    print(sorted(each(work, items, 2, lost=lost, backend=backend_of("dask"))))
"""


def program(*arguments):
    return subprocess.run([sys.executable, "-m", "comparisons", *map(str, arguments)], capture_output=True, text=True)


@contextmanager
def background(*arguments):
    """A program that is ended at the end of the block."""
    process = subprocess.Popen([sys.executable, "-m", *map(str, arguments)], stderr=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


@contextmanager
def cluster(folder, *options):
    """A scheduler and two workers of their own; the address of the scheduler."""
    file = folder / "scheduler.json"
    with background("distributed.cli.dask_scheduler", "--port", 0, "--no-dashboard", "--scheduler-file", file):
        while not (file.exists() and file.read_text()):
            time.sleep(0.05)
        with background("distributed.cli.dask_worker", "--scheduler-file", file, "--no-dashboard", *options):
            yield json.loads(file.read_text())["address"]


@pytest.fixture
def grid(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(GRID)
    return path


def tables(folder):
    return {name: (folder / name).read_bytes() for name in TABLES}


def test_a_local_cluster_writes_the_same_bytes(grid, tmp_path):
    done = program("sweep", grid, "--jobs", 2, "--backend", "dask", "--out", tmp_path / "dask", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(tmp_path / "one"), "--quiet"]) == 0
    assert tables(tmp_path / "dask") == tables(tmp_path / "one")


@pytest.mark.heavy
def test_a_worker_that_ends_is_replaced_and_its_item_tried_once_more(tmp_path):
    (tmp_path / "items.py").write_text(ITEMS)
    (tmp_path / "caller.py").write_text(CALLER)
    path = os.pathsep.join([str(Path(__file__).resolve().parents[3]), str(tmp_path)])
    command = [sys.executable, tmp_path / "caller.py", tmp_path]
    # The linear algebra would have two threads.
    environment = os.environ | {"PYTHONPATH": path, "OPENBLAS_NUM_THREADS": "2", "OMP_NUM_THREADS": "2"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert done.stdout == f"{sorted([*((name, [1]) for name in ('a', 'once', 'b', 'c', 'd')), ('always', 'lost')])}\n"
    assert done.stderr == "worker processes ended early: what they worked on (2) is tried once more\n"


@pytest.mark.heavy
def test_workers_of_a_scheduler_write_the_same_bytes(grid, tmp_path):
    with cluster(tmp_path, "--nworkers", 2, "--nthreads", 1) as address:
        options = ("--backend", "dask", "--scheduler", address, "--out", tmp_path / "dask")
        done = program("sweep", grid, *options)
    assert (done.returncode, "computations on a Dask cluster" in done.stderr) == (0, True)
    record = json.loads((tmp_path / "dask" / "run.json").read_text())
    assert (record["arguments"]["backend"], record["arguments"]["scheduler"]) == ("dask", address)
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(tmp_path / "one"), "--quiet"]) == 0
    assert tables(tmp_path / "dask") == tables(tmp_path / "one")


@pytest.mark.heavy
def test_a_worker_of_two_threads_is_refused(grid, tmp_path):
    with cluster(tmp_path, "--nworkers", 1, "--nthreads", 2) as address:
        done = program("sweep", grid, "--backend", "dask", "--scheduler", address, "--out", tmp_path / "o", "--quiet")
    assert done.returncode == 2
    assert "has 2 threads, and the solvers need processes of one thread: start it with" in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.heavy
def test_a_scheduler_that_is_not_there(grid, tmp_path):
    options = ("--backend", "dask", "--scheduler", "tcp://127.0.0.1:1", "--out", tmp_path / "o", "--quiet")
    done = program("sweep", grid, *options)
    assert done.returncode == 2
    assert "the Dask scheduler tcp://127.0.0.1:1 cannot be reached" in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("name", "scheduler", "sentence"),
    [
        ("dask", "10.0.0.1", "the scheduler 10.0.0.1 is not an address such as tcp://10.0.0.1:8786"),
        ("dask", "tcp://a:b", "is not an address"),
        ("processes", "tcp://a:1", "the scheduler tcp://a:1 belongs to the backend 'dask'"),
        ("slurm", None, "unknown backend 'slurm': the backends are processes, dask"),
    ],
)
def test_a_wrong_backend_is_refused(name, scheduler, sentence):
    with pytest.raises(ValueError, match=sentence):
        backend_of(name, scheduler)


def test_without_dask_it_is_said_what_to_install(monkeypatch):
    original = builtins.__import__

    def without_dask(name, *others):
        if name.partition(".")[0] in ("dask", "distributed"):
            raise ImportError
        return original(name, *others)

    monkeypatch.setattr(builtins, "__import__", without_dask)
    with pytest.raises(ValueError, match=r"pip install 'fscm-bench\[cluster\]'"):
        backend_of("dask")


@pytest.mark.heavy
def test_an_interrupt_ends_the_cluster_without_a_word_of_it(tmp_path):
    path, journal = tmp_path / "long.toml", tmp_path / "out" / "store.sqlite-wal"
    path.write_text(GRID.replace("md-improved", "fscm").replace("mu = [1, 3]", "mu = [1, 1.5, 2, 2.5, 3]"))
    command = [sys.executable, "-m", "comparisons", "sweep", path, "--jobs", "2", "--backend", "dask"]
    process = subprocess.Popen(
        [*command, "--out", tmp_path / "out"], stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    while process.poll() is None and not (journal.exists() and journal.stat().st_size > 30_000):
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, message = process.communicate()
    assert process.returncode == 130
    _, safe, last = message.splitlines()
    assert "finished computations are safe" in safe
    assert last == "python -m comparisons: interrupted"
    # The last process of the group to end is one of Python's own.
    while group_is_there(process.pid):
        time.sleep(0.01)


def group_is_there(number):
    try:
        os.killpg(number, 0)
    except ProcessLookupError:
        return False
    return True
