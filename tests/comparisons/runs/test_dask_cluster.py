"""The Dask backend: the same bytes as processes, workers that end, addresses, threads of a worker."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager, suppress

import pytest

from comparisons.cli.main import main
from comparisons.runs.workers import backend_of, each
from tests.comparisons.runs.test_workers import end

pytest.importorskip("distributed")

GRID = """
[[grid]]
id = "mine"
title = "Mine"
reference = "md-improved"
models = ["jkr", "md-original"]
quantities = ["pull_off_force", "force_curve"]
n = [1, 2]
k = [0, 0.4]
mu = [1, 3]
"""


def sweep(grid, *options):
    command = [sys.executable, "-m", "comparisons", "sweep", grid, "--backend", "dask", "--quiet", *map(str, options)]
    return subprocess.run(command, capture_output=True, text=True)


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
    """A scheduler and workers of their own; the address of the scheduler."""
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


def has_the_bytes_of_processes(grid, folder):
    alone = grid.parent / "alone"
    assert main(["sweep", str(grid), "--jobs", "1", "--out", str(alone), "--quiet"]) == 0
    for name in ("results.csv", "kappa.csv", "curves.csv"):
        assert (folder / name).read_bytes() == (alone / name).read_bytes()


def test_a_local_cluster_writes_the_same_bytes(grid, tmp_path):
    done = sweep(grid, "--jobs", 2, "--out", tmp_path / "dask")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    has_the_bytes_of_processes(grid, tmp_path / "dask")


@pytest.mark.heavy
def test_a_worker_that_ends_is_replaced_and_its_item_tried_once_more(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    items = ["a", str(tmp_path / "once"), "b", "always", "c", "d"]
    outputs = list(each(end, items, 2, lost=lambda item: (item, None), backend=backend_of("dask")))
    assert dict(outputs) == dict.fromkeys(items, (1,)) | {"always": None}
    assert "(2) is tried once more" in capsys.readouterr().err


@pytest.mark.heavy
def test_workers_of_a_scheduler_write_the_same_bytes(grid, tmp_path):
    with cluster(tmp_path, "--nworkers", 2, "--nthreads", 1) as address:
        assert sweep(grid, "--scheduler", address, "--out", tmp_path / "dask").returncode == 0
    arguments = json.loads((tmp_path / "dask" / "run.json").read_text())["arguments"]
    assert (arguments["backend"], arguments["scheduler"]) == ("dask", address)
    has_the_bytes_of_processes(grid, tmp_path / "dask")


@pytest.mark.heavy
def test_a_worker_of_two_threads_and_a_scheduler_that_is_not_there_are_refused(grid, tmp_path):
    with cluster(tmp_path, "--nworkers", 1, "--nthreads", 2) as address:
        threads = sweep(grid, "--scheduler", address, "--out", tmp_path / "threads")
    absent = sweep(grid, "--scheduler", "tcp://127.0.0.1:1", "--out", tmp_path / "absent")
    for done, named in ((threads, "has 2 threads"), (absent, "tcp://127.0.0.1:1 cannot be reached")):
        assert (done.returncode, done.stderr.count("\n")) == (2, 1)
        assert named in done.stderr


@pytest.mark.parametrize(
    ("name", "scheduler"), [("dask", "10.0.0.1"), ("dask", "tcp://a:b"), ("processes", "tcp://a:1"), ("slurm", None)]
)
def test_a_wrong_backend_is_refused(name, scheduler):
    with pytest.raises(ValueError, match=scheduler or name):
        backend_of(name, scheduler)


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed.comm.addressing", None)
    with pytest.raises(ValueError, match=r"pip install 'fscm-bench\[cluster\]'"):
        backend_of("dask")


@pytest.mark.heavy
def test_an_interrupt_ends_the_cluster_without_a_word_of_it(tmp_path):
    path, log = tmp_path / "long.toml", tmp_path / "out" / "store.sqlite-wal"
    path.write_text(GRID.replace("md-improved", "fscm").replace("mu = [1, 3]", "mu = [1, 1.5, 2, 2.5, 3]"))
    command = [sys.executable, "-m", "comparisons", "sweep", path, "--jobs", "2", "--backend", "dask"]
    process = subprocess.Popen(
        [*command, "--out", tmp_path / "out"], stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    while process.poll() is None and not (log.exists() and log.stat().st_size > 30_000):
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, message = process.communicate()
    assert process.returncode == 130
    _, safe, interrupted = message.splitlines()
    assert "finished computations are safe" in safe
    assert interrupted == "python -m comparisons: interrupted"
    # The last process of the group to end is one of Python's own.
    with suppress(ProcessLookupError):
        while True:
            os.killpg(process.pid, 0)
            time.sleep(0.01)
