"""Cache of function calls: each is made once, on every core, and its result is kept on disk.

An interrupted command loses no finished call: each is in a journal as soon as it ends, and the next command with the
same folder continues.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from contextlib import AbstractContextManager, closing
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from comparisons.model import ComputationFailed, NotApplicable
from comparisons.runs.store import Store
from comparisons.runs.workers import LOST, each

__all__ = ["CachedCall", "CallCache", "Results"]


@dataclass(frozen=True, slots=True)
class CachedCall:
    """A call of a function: the name of the function, and its arguments.

    The function must depend on its arguments alone and return what JSON can hold: finite numbers, texts, None,
    lists and dictionaries of them.  It may raise as a model does.
    """

    function: str
    arguments: tuple[float | str, ...]

    @classmethod
    def of(cls, function: Callable[..., Any], *arguments: float | str) -> CachedCall:
        """Return the call `function(*arguments)`, not made yet.

        Examples
        --------
        >>> from math import hypot
        >>> CachedCall.of(hypot, 3, 4)
        CachedCall(function='math:hypot', arguments=(3, 4))
        """
        return cls(f"{function.__module__}:{function.__qualname__}", arguments)

    @property
    def words(self) -> str:
        """The call as one would write it."""
        return f"{self.function.partition(':')[2]}({', '.join(map(str, self.arguments))})"


@dataclass(frozen=True, slots=True)
class _Outcome:
    call: CachedCall
    result: Any = None
    failure: str | None = None
    #: The failure is a refusal (`NotApplicable`), which another attempt does not change.
    refused: bool = False


def _read(line: dict[str, Any]) -> _Outcome:
    return _Outcome(
        CachedCall(line["function"], tuple(line["arguments"])), line["result"], line["failure"], line["refused"]
    )


def _written(outcome: _Outcome) -> dict[str, Any]:
    return asdict(outcome.call) | {
        "result": outcome.result,
        "failure": outcome.failure,
        "refused": outcome.refused,
    }


def _lost(call: CachedCall) -> _Outcome:
    return _Outcome(call, failure=LOST)


def _make(call: CachedCall) -> _Outcome:
    module, _, name = call.function.partition(":")
    try:
        return _Outcome(call, result=getattr(import_module(module), name)(*call.arguments))
    except (ComputationFailed, NotApplicable) as error:
        return _Outcome(call, failure=str(error), refused=isinstance(error, NotApplicable))


class Results:
    """Results of calls."""

    def __init__(self) -> None:
        self._outcomes: dict[CachedCall, _Outcome] = {}

    def add(self, outcome: _Outcome) -> None:
        """Keep one."""
        self._outcomes[outcome.call] = outcome

    def remove(self, call: CachedCall) -> None:
        """Remove one."""
        del self._outcomes[call]

    def failed(self, call: CachedCall) -> bool:
        """Whether the function raised `ComputationFailed`, or returned a dictionary with the status ``"failed"``."""
        outcome = self._outcomes[call]
        if outcome.failure is not None:
            return not outcome.refused
        return isinstance(outcome.result, dict) and outcome.result.get("status") == "failed"

    def __contains__(self, call: CachedCall) -> bool:
        return call in self._outcomes

    def __getitem__(self, call: CachedCall) -> Any:
        """Return the result of a call.

        Raises
        ------
        ComputationFailed
            If the function raised an exception; the message is its reason.
        """
        outcome = self._outcomes[call]
        if outcome.failure is not None:
            raise ComputationFailed(f"{call.words}: {outcome.failure}")
        return outcome.result


class CallCache:
    """Function calls with their results in a journal.

    Parameters
    ----------
    path : Path
        The journal; made when it does not exist.
    fingerprint : str
        Identifies the code.  A journal of other code is refused: its results may differ.

    Raises
    ------
    ValueError
        If the file is not a journal, or one of other code.
    """

    def __init__(self, path: Path, fingerprint: str) -> None:
        self._journal = Store(path, fingerprint, _read, _written)
        self._journal.drop(lambda outcome: outcome.failure == LOST)
        self.results = Results()
        for outcome in self._journal.items:
            self.results.add(outcome)

    def kept(self) -> AbstractContextManager[None]:
        """State what is safe if the work is interrupted, as `comparisons.runs.store.Store.kept`."""
        return self._journal.kept()

    def failed(self, calls: Iterable[CachedCall]) -> list[CachedCall]:
        """Return the calls that are stored as failures, each once, in their order."""
        return [call for call in dict.fromkeys(calls) if call in self.results and self.results.failed(call)]

    def forget(self, calls: Iterable[CachedCall]) -> None:
        """Remove stored results: the calls are made again."""
        unwanted = set(calls)
        self._journal.drop(lambda outcome: outcome.call in unwanted)
        for call in unwanted:
            self.results.remove(call)

    def parts_of(self, calls: Iterable[CachedCall]) -> list[dict[str, Any]]:
        """Return the parts that made calls, in order, as the record of a run holds them."""
        used = set(calls)
        return self._journal.parts(lambda outcome: outcome.call in used)

    def missing(self, calls: Iterable[CachedCall]) -> list[CachedCall]:
        """Return the calls that have no result yet, each once, in their order."""
        return [call for call in dict.fromkeys(calls) if call not in self.results]

    def work(self, calls: Iterable[CachedCall], jobs: int) -> Generator[CachedCall]:
        """Make the calls that have no result yet, on `jobs` processes; yield each as soon as it ends.

        Raises
        ------
        ValueError
            If a result cannot be kept, as one that holds a NaN.
        """
        with closing(each(_make, self.missing(calls), jobs, lost=_lost)) as outcomes:
            for outcome in outcomes:
                self._journal.add(outcome)
                # New results and stored results must be the same, so that a resumed run writes the same files.
                self.results.add(outcome)
                yield outcome.call
