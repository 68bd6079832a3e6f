"""Ctrl-C while processes start: it waits until they can be ended without a traceback."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["blocked", "handled_later", "unblock"]


@contextmanager
def blocked(number: signal.Signals) -> Iterator[None]:
    """Block a signal in this thread and, where the system has masks, in the processes that are started in the block."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [number])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def handled_later(*numbers: signal.Signals) -> Iterator[None]:
    """Handle signals at the end of the block.

    To block them in this thread is not enough: the system may deliver them to another one, such as those of the
    linear algebra, and Python calls the handler in the main thread all the same.

    Examples
    --------
    >>> try:
    ...     with handled_later(signal.SIGINT):
    ...         signal.raise_signal(signal.SIGINT)
    ...         print("finished")
    ... except KeyboardInterrupt:
    ...     print("interrupted")
    finished
    interrupted
    """
    if threading.current_thread() is not threading.main_thread():  # where no handler is called
        yield
        return
    received: list[int] = []
    before = {number: signal.signal(number, lambda signum, frame: received.append(signum)) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        for signum in received:
            signal.raise_signal(signum)


def unblock(number: signal.Signals) -> None:
    """Receive a signal that was blocked when this process was started; one that waits is handled at once."""
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [number])
