"""Cache of function calls: each is made once, on every core, and its result is kept on disk.

An interrupted command loses no finished call: each is in a store as soon as it ends, and the next command with the
same folder continues.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any, NamedTuple

from comparisons.model import ComputationFailed, NotApplicable
from comparisons.runs.store import Form, Store
from comparisons.runs.workers import LOST, each


@dataclass(frozen=True, slots=True)
class CachedCall:
    """A call of a function: the name of the function, and its arguments.

    The function must depend on its arguments alone and return what JSON can hold: finite numbers, texts, None,
    lists and dictionaries of them.  It may raise as a model does.
    """

    function: str
    arguments: tuple[float | str, ...]

    @classmethod
    def of(cls, function: Callable[..., Any], *arguments: float | str, **named: float | str) -> CachedCall:
        """Return the call `function(*arguments, **named)`, not made yet.

        Examples
        --------
        >>> CachedCall.of(pow, exp=4, base=3)
        CachedCall(function='builtins:pow', arguments=(3, 4))
        """
        bound = signature(function).bind(*arguments, **named)
        if bound.kwargs:
            raise TypeError(f"{function.__qualname__}: no argument before {', '.join(bound.kwargs)} may be left out")
        return cls(f"{function.__module__}:{function.__qualname__}", bound.args)

    @property
    def name(self) -> str:
        """Name of the function."""
        return self.function.partition(":")[2]


class Outcome(NamedTuple):
    """What came of a call: its result, or why it has none."""

    call: CachedCall
    result: Any = None
    failure: str = ""

    @property
    def failed(self) -> bool:
        """Whether the function raised an exception, or returned a dictionary with the status ``"failed"``."""
        return bool(self.failure) or (isinstance(self.result, dict) and self.result.get("status") == "failed")

    @property
    def sentence(self) -> str:
        """The call and its failure."""
        return f"{self.call.name}({', '.join(map(str, self.call.arguments))}): {self.failure}"

    def get(self) -> Any:
        """Return the result.

        Raises
        ------
        ComputationFailed
            If the function raised an exception; the message is its reason.
        """
        if self.failure:
            raise ComputationFailed(self.sentence)
        return self.result


def _make(call: CachedCall) -> Outcome:
    module, _, name = call.function.partition(":")
    try:
        return Outcome(call, getattr(import_module(module), name)(*call.arguments))
    except (ComputationFailed, NotApplicable) as error:
        return Outcome(call, failure=str(error))
    except Exception as error:
        # A defect of a function costs its own results and no others.
        return Outcome(call, failure=f"{type(error).__name__}: {error}")


def _lost(call: CachedCall) -> Outcome:
    return Outcome(call, failure=LOST)


_FORM: Form[Outcome] = Form(
    "calls",
    key=lambda outcome: [outcome.call.function, *outcome.call.arguments],
    read=lambda line: Outcome(CachedCall(line[0], tuple(line[1])), *line[2:]),
    write=lambda outcome: [outcome.call.function, outcome.call.arguments, *outcome[1:]],
)


class MadeCalls(NamedTuple):
    """Calls with their outcomes, how many were made now, and the commands that made them, as in the record of a run."""

    outcomes: dict[CachedCall, Outcome]
    made: int
    parts: list[dict[str, Any]]


def make_calls(calls: Iterable[CachedCall], folder: Path, jobs: int = 1, *, apart: bool = False) -> MadeCalls:
    """Make the calls that the store of a folder does not have, or has as failures, each once.

    Parameters
    ----------
    calls : iterable of CachedCall
    folder : Path
    jobs : int
        Number of processes.
    apart : bool
        Whether each call is made in a new process, one after the other.

    Raises
    ------
    ValueError
        If the folder holds results of other code, or a result cannot be kept, as one that holds a NaN.
    comparisons.model.ComputationFailed
        If the workers cannot compute.
    """
    planned = dict.fromkeys(calls)
    with Store(folder, _FORM) as store:
        store.drop(lambda outcome: outcome.call in planned and outcome.failed)
        stored = {outcome.call for outcome in store.items}
        missing = [call for call in planned if call not in stored]
        groups = [[call] for call in missing] if apart else [missing]
        # With one job a call is made in this process.
        outcomes = (outcome for group in groups for outcome in each(_make, group, 2 if apart else jobs, lost=_lost))
        store.complete("computations", len(missing), outcomes)
        parts = store.parts(lambda outcome: outcome.call in planned)
        return MadeCalls({outcome.call: outcome for outcome in store.items}, len(missing), parts)
