"""Calls of functions by name, made once, on every core, their answers kept on disk.

An interrupted run loses no finished call: the journal gains a line as each ends, and the same folder goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from contextlib import closing
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from comparisons.model import ComputationFailed, NotApplicable
from comparisons.runs.journal import Journal
from comparisons.runs.workers import each

__all__ = ["CallCache", "Results", "Task"]


@dataclass(frozen=True, slots=True)
class Task:
    """A function of a module, by name, and the numbers and words it is called with.

    The function must depend on its arguments alone and return what JSON can hold: finite numbers, texts, None,
    lists and dictionaries of them.  It may raise as a model does.
    """

    function: str
    arguments: tuple[float | str, ...]

    @classmethod
    def of(cls, function: Callable[..., Any], *arguments: float | str) -> Task:
        """Return the call `function(*arguments)`, not made yet.

        Examples
        --------
        >>> from math import hypot
        >>> Task.of(hypot, 3, 4)
        Task(function='math:hypot', arguments=(3, 4))
        """
        return cls(f"{function.__module__}:{function.__qualname__}", arguments)

    @property
    def words(self) -> str:
        """The call as one would write it."""
        return f"{self.function.partition(':')[2]}({', '.join(map(str, self.arguments))})"


@dataclass(frozen=True, slots=True)
class _Outcome:
    call: Task
    answer: Any = None
    failure: str | None = None
    #: The failure is a refusal (`NotApplicable`), which another attempt does not change.
    refused: bool = False


def _read(line: dict[str, Any]) -> _Outcome:
    return _Outcome(Task(line["function"], tuple(line["arguments"])), line["answer"], line["failure"], line["refused"])


def _written(outcome: _Outcome) -> dict[str, Any]:
    return asdict(outcome.call) | {
        "answer": outcome.answer,
        "failure": outcome.failure,
        "refused": outcome.refused,
    }


def _make(call: Task) -> _Outcome:
    module, _, name = call.function.partition(":")
    try:
        return _Outcome(call, answer=getattr(import_module(module), name)(*call.arguments))
    except (ComputationFailed, NotApplicable) as error:
        return _Outcome(call, failure=str(error), refused=isinstance(error, NotApplicable))


class Results:
    """What the tasks returned, by call."""

    def __init__(self) -> None:
        self._outcomes: dict[Task, _Outcome] = {}

    def add(self, outcome: _Outcome) -> None:
        """Keep one."""
        self._outcomes[outcome.call] = outcome

    def remove(self, call: Task) -> None:
        """Remove one."""
        del self._outcomes[call]

    def failed(self, call: Task) -> bool:
        """Whether the function raised `ComputationFailed`, or returned a dictionary with the status ``"failed"``."""
        outcome = self._outcomes[call]
        if outcome.failure is not None:
            return not outcome.refused
        return isinstance(outcome.answer, dict) and outcome.answer.get("status") == "failed"

    def __contains__(self, call: Task) -> bool:
        return call in self._outcomes

    def __getitem__(self, call: Task) -> Any:
        """Return the answer to a call.

        Raises
        ------
        ComputationFailed
            If the function did not return one; the message is its reason.
        """
        outcome = self._outcomes[call]
        if outcome.failure is not None:
            raise ComputationFailed(f"{call.words}: {outcome.failure}")
        return outcome.answer


class CallCache:
    """Makes tasks and keeps their answers in a journal.

    Parameters
    ----------
    path : Path
        The journal; made when it does not exist.
    fingerprint : str
        Identifies the code.  A journal of other code is refused: its answers may differ.

    Raises
    ------
    ValueError
        If the file is not a journal, or one of other code.
    """

    def __init__(self, path: Path, fingerprint: str) -> None:
        self._journal = Journal(path, fingerprint, _read, _written)
        self.answers = Results()
        for outcome in self._journal.entries:
            self.answers.add(outcome)

    def failed(self, tasks: Iterable[Task]) -> list[Task]:
        """Return those tasks whose stored answer is that they failed, each once, in the order given."""
        return [call for call in dict.fromkeys(tasks) if call in self.answers and self.answers.failed(call)]

    def forget(self, tasks: Iterable[Task]) -> None:
        """Remove stored answers: the tasks are made again."""
        unwanted = set(tasks)
        self._journal.drop(lambda outcome: outcome.call in unwanted)
        for call in unwanted:
            self.answers.remove(call)

    def missing(self, tasks: Iterable[Task]) -> list[Task]:
        """Return those tasks that have no answer yet, each once, in the order given."""
        return [call for call in dict.fromkeys(tasks) if call not in self.answers]

    def work(self, tasks: Iterable[Task], jobs: int) -> Generator[Task]:
        """Make the tasks that have no answer yet, on `jobs` processes; yield each as it is answered.

        Raises
        ------
        ValueError
            If an answer cannot be kept, as one that holds a NaN.
        """
        with closing(each(_make, self.missing(tasks), jobs)) as outcomes:
            for outcome in outcomes:
                self._journal.add(outcome)
                # Results fresh and read again must be the same, so that a resumed run writes the same files.
                self.answers.add(outcome)
                yield outcome.call
