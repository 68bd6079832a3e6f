"""Closed forms, the judge, tables, figures and the command line.

The names below are loaded when they are first used, so that ``import comparisons`` is fast.

Examples
--------
>>> from comparisons import Problem, evaluate
>>> evaluate("bradley", "pull_off_force", Problem.dimensionless(n=2, k=0.4, mu=1)).value
2.0
"""

from __future__ import annotations

from importlib import import_module

#: Not imported from typing: `python -m comparisons` would look for it in the working folder first.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

#: Public name -> the module that defines it.
_EXPORTS = {
    "Model": "comparisons.model",
    "Result": "comparisons.model",
    "Curve": "comparisons.model",
    "NotApplicable": "comparisons.model",
    "ComputationFailed": "comparisons.model",
    "QUANTITIES": "comparisons.quantities",
    "create": "comparisons.registry",
    "Problem": "comparisons.problem",
    "evaluate": "comparisons.runs.tasks",
    "curve": "comparisons.runs.tasks",
    "errors": "comparisons.pipeline.compare",
    "compare": "comparisons.pipeline.compare",
    "sensitivity": "comparisons.description.uncertainty",
    "fit": "comparisons.fitting.fit",
    "run": "comparisons.pipeline.run",
    "judge": "comparisons.judging.judge",
    "judge_folder": "comparisons.pipeline.judgement",
}

__all__ = [*_EXPORTS]


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name not in _EXPORTS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_EXPORTS[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_EXPORTS})
