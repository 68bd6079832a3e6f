"""Check of the methods of a model before the first case: they exist and take the arguments they are called with."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed

__all__ = ["check_methods"]

#: Arguments of each method that is called.
_ARGUMENTS = {
    "evaluate": ("problem", "quantity"),
    "evaluate_physical": ("problem", "quantity"),
    "curve": ("problem",),
}


def check_methods(model: Any, physical: bool) -> None:
    """Refuse a model without a method that is called, or with one that takes other arguments.

    Parameters
    ----------
    model : object
    physical : bool
        Whether `evaluate_physical` is called in place of `evaluate`.

    Raises
    ------
    TypeError
        If there is no method `evaluate`.
    ComputationFailed
        If a method takes other arguments; the sentence has its place in the model's file.

    Examples
    --------
    >>> class Mine:
    ...     def evaluate(self, problem): ...
    >>> check_methods(Mine(), physical=False)
    Traceback (most recent call last):
    ...
    comparisons.model.ComputationFailed: Mine.evaluate(problem) ... is called as evaluate(problem, quantity): ...
    """
    if not physical and not callable(getattr(model, "evaluate", None)):
        raise TypeError("the model has no method evaluate(problem, quantity)")
    for name in ("evaluate_physical" if physical else "evaluate", "curve"):
        method = getattr(model, name, None)
        if callable(method):
            _check_arguments(method, name)


def _check_arguments(method: Any, name: str) -> None:
    try:
        signature = inspect.signature(method)
    except (TypeError, ValueError):  # of a compiled method nothing is known
        return
    arguments = _ARGUMENTS[name]
    try:
        signature.bind(*arguments)
    except TypeError:
        title = one_line(f"{getattr(method, '__qualname__', name)}{signature}", 120)
        called = f"{name}({', '.join(arguments)})"
        raise ComputationFailed(
            f"{title}{_place(method)} is called as {called}: write def {name}(self, {', '.join(arguments)})"
        ) from None


def _place(method: Any) -> str:
    """Return where a method is defined, as far as it is in a file."""
    code = getattr(inspect.unwrap(method), "__code__", None)
    return "" if code is None else f" in line {code.co_firstlineno} of {Path(code.co_filename).name}"
