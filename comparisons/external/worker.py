"""Program of the process of a model in Python, which loads the model and evaluates it, one JSON object a line.

It has the protocol of a program in any language (docs/judge_your_model.md).  Before any code of the model runs, stdin,
stdout and stderr are redirected to the null device, so a model may print what it likes.
"""

from __future__ import annotations

import inspect
import json
import os
import sys
import traceback
from collections.abc import Callable
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

from comparisons.domain import declared_domain
from comparisons.external.fingerprint import fingerprint, imported_files, roots_of
from comparisons.external.limits import cpu_seconds_from_now
from comparisons.external.physical_model import InUnits, PhysicalModel
from comparisons.external.reply_checks import column, count, kind, real
from comparisons.external.text_rules import TEXTS, one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from fscm.problem import Problem

__all__ = ["check_methods", "serve"]

_OURS = Path(__file__).resolve().parent.parent

#: Arguments of each method that is called.
_ARGUMENTS = {
    "evaluate": ("problem", "quantity"),
    "evaluate_physical": ("problem", "quantity"),
    "curve": ("problem",),
}


def serve(source: dict[str, Any], megabytes: float, seconds: float) -> None:
    """Serve requests until there are no more.

    Parameters
    ----------
    source : dict
        How the model is found.
    megabytes, seconds : float
        Its limits.
    """
    requests, replies = os.fdopen(os.dup(0), "r", encoding="utf-8"), os.fdopen(os.dup(1), "w", encoding="utf-8")
    null = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(null, stream)
    model: Any = None
    for line in requests:
        request = json.loads(line)
        loading = request["request"] == "describe"
        try:
            cpu_seconds_from_now(seconds)
            if loading:
                model, files = _loaded(source)
                reply = _description(model, files, source)
            else:
                reply = {"evaluate": _evaluated, "curve": _curve}[request["request"]](model, request, source)
            text = json.dumps({"status": "ok"} | reply, allow_nan=False)
        except NotApplicable as refusal:
            text = json.dumps({"status": "not-applicable", "reason": _words(refusal)})
        except BaseException as error:
            text = json.dumps({"status": "failed", "reason": _explain(error, megabytes, loading)})
        replies.write(text + "\n")
        replies.flush()


def _loaded(source: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
    """Return the model, and where its files are."""
    installed: list[Path] = []
    if source["kind"] == "file":
        file = Path(source["file"])
        made, module = _load_file(file, source["attribute"]), file.stem
    else:
        # It takes a tenth of the start of a process, and a file does not need it.
        from importlib.metadata import entry_points

        (found,) = {entry for entry in entry_points(group=source["group"]) if entry.name == source["name"]}
        made, module = found.load(), found.module
        listed = found.dist.files if found.dist else None
        installed = [Path(str(path.locate())).resolve() for path in listed or ()]
    model = made() if callable(made) else made
    defined = (made if isinstance(made, type) else type(model)).__module__
    return model, {"roots": roots_of((module, defined)), "installed": installed, "imported": imported_files()}


def _load_file(file: Path, attribute: str) -> Any:
    """Return what a file defines under a name; modules beside the file can be imported by it."""
    sys.path.insert(0, str(file.parent))
    spec = spec_from_file_location(file.stem, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"{file.name} is not a Python file")
    module = module_from_spec(spec)
    # Registered first, as an import does: dataclasses look their module up.
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    if not hasattr(module, attribute):
        raise AttributeError(f"{file.name} does not define {attribute}")
    return getattr(module, attribute)


def _description(model: Any, files: dict[str, Any], source: dict[str, Any]) -> dict[str, Any]:
    if missing := [name for name in TEXTS if not hasattr(model, name)]:
        raise ComputationFailed(f"the model has no {', '.join(missing)}; it needs {', '.join(TEXTS)}")
    limits = getattr(model, "limits", ())
    domain = declared_domain(model)
    physical = isinstance(model, PhysicalModel)
    check_methods(model, physical)
    digest, hashed = fingerprint(**files, declared=getattr(model, "files", ()), skip=source["skip"])
    return {
        **{name: str(getattr(model, name)) for name in TEXTS},
        "limits": [*limits] if isinstance(limits, tuple | list | set | frozenset) else limits,
        "applies_to": None if domain is None else domain.as_json(),
        "curve": callable(getattr(model, "curve", None)),
        "physical": physical,
        "digest": digest,
        "hashed": hashed,
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
    arguments = ", ".join(_ARGUMENTS[name])
    try:
        signature.bind(*_ARGUMENTS[name])
    except TypeError:
        code = getattr(inspect.unwrap(method), "__code__", None)
        place = "" if code is None else f" in line {code.co_firstlineno} of {Path(code.co_filename).name}"
        title = one_line(f"{getattr(method, '__qualname__', name)}{signature}", 120)
        raise ComputationFailed(
            f"{title}{place} is called as {name}({arguments}): write def {name}(self, {arguments})"
        ) from None


def _evaluated(model: Any, request: dict[str, Any], source: dict[str, Any]) -> dict[str, Any]:
    if isinstance(model, PhysicalModel):
        model = InUnits(model, source["poisson_ratio"], request.get("scales", 0))
    result = model.evaluate(_problem(request), request["quantity"])
    if not isinstance(result, Result):
        raise ComputationFailed(f"the model returned {kind(result)}, which is not a comparisons.model.Result")
    return {
        **{name: real(name, getattr(result, name)) for name in ("value", "u_num", "residual")},
        **{name: count(name, getattr(result, name)) for name in ("size", "iterations")},
    }


def _curve(model: Any, request: dict[str, Any], _: dict[str, Any]) -> dict[str, Any]:
    curve = model.curve(_problem(request))
    if not isinstance(curve, Curve):
        raise ComputationFailed(f"the model returned {kind(curve)}, which is not a comparisons.model.Curve")
    return {
        **{name: column(name, getattr(curve, name)).tolist() for name in ("displacement", "load")},
        "columns": {str(name): column(str(name), values).tolist() for name, values in curve.columns.items()},
    }


def _problem(request: dict[str, Any]) -> Problem:
    return Problem(request["n"], request["k"], request["mu"])


def _is_of_model(filename: str) -> bool:
    """Whether a line of a traceback is code of the model, not of this program."""
    return not filename.startswith("<") and not Path(filename).is_relative_to(_OURS)


def _words(thing: object, by: Callable[[object], str] = str) -> str:
    """Return the text of an exception; its class may be of the model, and the conversion may fail."""
    try:
        return one_line(by(thing))
    except BaseException as worse:
        return f"its text cannot be had: __{by.__name__}__ raises {type(worse).__name__}"


def _explain(error: BaseException, megabytes: float, loading: bool) -> str:
    """Return one line about a failure: the text of a `ComputationFailed`, else the error and its place in the code."""
    if isinstance(error, ComputationFailed):
        return _words(error)
    name = type(error).__name__
    if isinstance(error, MemoryError):
        return f"MemoryError: the model needs more than its {megabytes:g} MB"
    if isinstance(error, SystemExit):
        return f"SystemExit: the model called sys.exit({one_line(_words(error.code, repr), 60)})"
    if isinstance(error, SyntaxError) and error.lineno and error.filename and _is_of_model(error.filename):
        # It has no frame of its own: the place is in the exception.
        return one_line(f"{name} in line {error.lineno} of {Path(error.filename).name}: {error.msg}")
    every = traceback.extract_tb(error.__traceback__)
    # The place in the author's code, where for instance a Result was made of a text.
    frames = [frame for frame in every if _is_of_model(frame.filename)] or every
    place = f" in {frames[-1].name}, line {frames[-1].lineno} of {Path(frames[-1].filename).name}" if frames else ""
    # Loading a model involves no case.
    hint = " (a case outside the domain is NotApplicable)" if isinstance(error, ValueError) and not loading else ""
    return one_line(f"{name}{place}: {_words(error)}{hint}")
