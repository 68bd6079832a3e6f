"""Ctrl-C while processes start."""

import signal
import subprocess
import sys
import threading
import time

import pytest

from comparisons.runs.interrupts import handled_later


def test_a_signal_that_another_thread_receives_waits_for_the_end_of_the_block():
    end = threading.Event()
    other = threading.Thread(target=end.wait)
    other.start()
    finished = False
    try:
        with pytest.raises(KeyboardInterrupt), handled_later(signal.SIGINT):  # noqa: PT012 - the end of the block counts
            signal.pthread_kill(other.ident, signal.SIGINT)
            time.sleep(0.1)
            finished = True
    finally:
        end.set()
        other.join()
    assert finished
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="the system has no masks of signals")
def test_ctrl_c_while_workers_start_leaves_no_traceback():
    script = (
        "import os, signal, threading\n"
        "from comparisons.runs.workers import each\n"
        "threading.Timer(0.2, os.killpg, (0, signal.SIGINT)).start()\n"
        "try:\n"
        "    list(each(abs, [1, 2], 2, lost=abs))\n"
        "    list(each(abs, range(10**6), 2, lost=abs))\n"
        "except KeyboardInterrupt:\n"
        "    pass\n"
    )
    ended = subprocess.run([sys.executable, "-c", script], process_group=0, capture_output=True, text=True, timeout=600)
    assert (ended.returncode, ended.stderr) == (0, "")
