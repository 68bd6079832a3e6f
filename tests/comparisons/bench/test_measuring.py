"""CPU time and memory of a measurement, and processes that end."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from comparisons.bench.measuring import ENDED, cpu_seconds, made, memory, reset_peak
from comparisons.bench.part import Part

needs_proc = pytest.mark.skipif(not Path("/proc/self/status").is_file(), reason="the system has no /proc")


def process_of(settings):
    return {"process": os.getpid(), "threads": os.environ.get("OPENBLAS_NUM_THREADS")}


def ended(settings):
    os._exit(1)


def part_of(measure, own_process=True):
    return Part("test", "", lambda full: [], measure, None, None, None, own_process)


def test_each_measurement_has_a_process_of_its_own_with_one_thread():
    first, second = (made(part_of(process_of), {}) for _ in range(2))
    assert len({first.numbers["process"], second.numbers["process"], os.getpid()}) == 3
    assert first.numbers["threads"] == "1"
    assert made(part_of(process_of, own_process=False), {}).numbers["process"] == os.getpid()


def test_a_process_that_ends_is_a_failed_measurement():
    failed = made(part_of(ended), {"size": 3})
    assert (failed.status, failed.reason, failed.settings) == ("failed", ENDED, {"size": 3})


def test_every_repetition_is_another_problem_and_the_first_output_counts():
    seen = []
    output, seconds = cpu_seconds(lambda repetition: seen.append(repetition) or repetition)
    assert (output, seen) == (0, [0, 1, 2])
    assert seconds >= 0.0


def test_a_long_computation_is_not_repeated(monkeypatch):
    clock = iter([0.0, 5.0])
    monkeypatch.setattr("comparisons.bench.measuring.time.process_time", lambda: next(clock))
    assert cpu_seconds(lambda repetition: repetition) == (0, 5.0)


@needs_proc
def test_the_peak_is_that_since_it_was_reset():
    before = memory()
    large = np.ones(8_000_000)
    del large
    assert memory("VmHWM") >= before + 60.0
    reset_peak()
    if Path("/proc/self/clear_refs").exists() and os.access("/proc/self/clear_refs", os.W_OK):
        assert memory("VmHWM") < before + 40.0


@pytest.mark.parametrize(
    ("end", "status"), [(signal.SIGINT, 130), pytest.param(signal.SIGKILL, -9, marks=pytest.mark.heavy)]
)
def test_a_stopped_run_keeps_what_is_finished_and_leaves_no_process(end, status, tmp_path):
    command = [sys.executable, "-m", "comparisons", "bench", "--only", "growth", "--out", str(tmp_path), "--quiet"]
    # A group of its own, as a shell makes it: Ctrl-C goes to all its processes.
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, process_group=0)
    journal = tmp_path / "bench.jsonl"
    while process.poll() is None and (not journal.exists() or journal.read_bytes().count(b"\n") < 2):
        time.sleep(0.05)
    (os.killpg if end == signal.SIGINT else os.kill)(process.pid, end)
    # The end of the pipe: no process of the run is left that could write to it.
    _, messages = process.communicate(timeout=120)
    assert process.returncode == status
    if end == signal.SIGINT:
        assert messages.splitlines()[-1] == "python -m comparisons: interrupted"
        assert f"finished computations are safe; go on with --out {tmp_path}" in messages
    # After SIGKILL Python itself remarks on semaphores, and on a process that has just been started: the end of the
    # pipe from its parent is an EOFError there.  No line is of our code.
    assert "/comparisons/" not in messages
    lines = journal.read_text().splitlines()
    assert 2 <= len(lines) < 26
    assert all(json.loads(line) for line in lines[:2])
