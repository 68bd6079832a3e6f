"""Functions that worker processes call: each process imports this module, which loads little."""

import os
import signal
import time
from pathlib import Path

import threadpoolctl


def threads(_):
    """The process, and the threads of its linear algebra libraries."""
    return os.getpid(), {library["num_threads"] for library in threadpoolctl.threadpool_info()}


def fail(item):
    raise ValueError(f"{item} is refused")


def end(item):
    """End this process as the system does when there is no memory: always, or the first time for a path."""
    path = Path(item)
    if item == "always" or (path.is_absolute() and not path.exists()):
        path.is_absolute() and path.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return item, tuple(threads(item)[1])


def nap(seconds):
    time.sleep(seconds)
    return os.getpid()


def process(_):
    return os.getpid()


def defect(x):
    return x["key"]
