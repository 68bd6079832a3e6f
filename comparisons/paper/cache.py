"""Cache of function calls: each is made once, on every core, and its result is kept on disk.

An interrupted command loses no finished call: each is in a store as soon as it ends, and the next command with the
same folder continues.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from comparisons.model import ComputationFailed, NotApplicable
from comparisons.runs.computation import log_failures_used
from comparisons.runs.store import Form, Store
from comparisons.runs.workers import LOST, each

__all__ = ["CachedCall", "MadeCalls", "Results", "make_calls"]


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


class _Outcome(NamedTuple):
    call: CachedCall
    result: Any = None
    failure: str | None = None
    #: The failure is a refusal (`NotApplicable`), which another attempt does not change.
    refused: bool = False


def _read(line: list[Any]) -> _Outcome:
    function, arguments, *outcome = line
    return _Outcome(CachedCall(function, tuple(arguments)), *outcome)


def _written(outcome: _Outcome) -> list[Any]:
    call, *fields = outcome
    return [call.function, call.arguments, *fields]


def _lost(call: CachedCall) -> _Outcome:
    return _Outcome(call, failure=LOST)


def _make(call: CachedCall) -> _Outcome:
    module, _, name = call.function.partition(":")
    try:
        return _Outcome(call, result=getattr(import_module(module), name)(*call.arguments))
    except (ComputationFailed, NotApplicable) as error:
        return _Outcome(call, failure=str(error), refused=isinstance(error, NotApplicable))


class Results(dict[CachedCall, Any]):
    """Results of calls."""

    def lost(self, call: CachedCall) -> bool:
        """Whether the process of a call ended before its result."""
        return bool(super().__getitem__(call).failure == LOST)

    def failed(self, call: CachedCall) -> bool:
        """Whether the function raised `ComputationFailed`, or returned a dictionary with the status ``"failed"``."""
        _, result, failure, refused = super().__getitem__(call)
        if failure is not None:
            return not refused
        return isinstance(result, dict) and result.get("status") == "failed"

    def __getitem__(self, call: CachedCall) -> Any:
        """Return the result of a call.

        Raises
        ------
        ComputationFailed
            If the function raised an exception; the message is its reason.
        """
        outcome = super().__getitem__(call)
        if outcome.failure is not None:
            raise ComputationFailed(f"{call.words}: {outcome.failure}")
        return outcome.result


def _results(outcomes: Iterable[_Outcome]) -> Results:
    return Results({outcome.call: outcome for outcome in outcomes})


_FORM: Form[_Outcome] = Form("calls", lambda outcome: [outcome.call.function, *outcome.call.arguments], _read, _written)


@dataclass(frozen=True, slots=True)
class MadeCalls:
    """Calls with their results.

    Attributes
    ----------
    results : Results
    made : int
        How many of the calls were made now.
    parts : list of dict
        The commands that made the calls, as the record of a run holds them.
    """

    results: Results
    made: int
    parts: list[dict[str, Any]]

    def failed(self, calls: Iterable[CachedCall]) -> list[CachedCall]:
        """Return the calls that failed, each once, in their order."""
        return [call for call in dict.fromkeys(calls) if self.results.failed(call)]


def make_calls(
    calls: Iterable[CachedCall],
    folder: Path,
    jobs: int = 1,
    *,
    retry_failed: bool = False,
    code: str | None = None,
    description: str = "paper",
) -> MadeCalls:
    """Make the calls that the store of a folder does not have, each once.

    Parameters
    ----------
    calls : iterable of CachedCall
    folder : Path
    jobs : int
        Number of processes.
    retry_failed : bool
        Whether stored failures are made again.
    code : str, optional
        As of `comparisons.runs.store.Store`.
    description : str
        Of the progress bar.

    Raises
    ------
    ValueError
        If the folder holds results of other code, or a result cannot be kept, as one that holds a NaN.
    comparisons.model.ComputationFailed
        If the workers cannot compute.
    """
    planned = list(dict.fromkeys(calls))
    with Store(folder, _FORM, code) as store:
        stored = _results(store.items)
        failed = [call for call in planned if call in stored and stored.failed(call)]
        again = {call for call in failed if retry_failed or stored.lost(call)}
        store.drop(lambda outcome: outcome.call in again)
        log_failures_used(Counter(call.function.partition(":")[2] for call in failed if call not in again))
        missing = [call for call in planned if call not in stored or call in again]
        store.complete(description, len(missing), _outcomes(missing, jobs))
        used = set(planned)
        return MadeCalls(_results(store.items), len(missing), store.parts(lambda outcome: outcome.call in used))


def _outcomes(calls: list[CachedCall], jobs: int) -> Generator[tuple[_Outcome, None]]:
    for outcome in each(_make, calls, jobs, lost=_lost):
        yield outcome, None
