"""Program of the child process, which loads one external model and evaluates it, one JSON object a line.

Requests come on what was stdin; replies go to a descriptor of their own.  Before any code of the model runs,
stdin, stdout and stderr are redirected to the null device, so a model may print what it likes.
"""

from __future__ import annotations

import json
import math
import numbers
import os
import select
import sys
import threading
import time
import traceback
from collections.abc import Callable
from importlib.metadata import entry_points
from pathlib import Path
from typing import IO, Any

import numpy as np

from comparisons.external.fingerprint import fingerprint
from comparisons.external.limits import LARGEST_COUNT, Limits, cpu_seconds_from_now, limit_resources
from comparisons.external.model_file import load_file
from comparisons.external.physical_model import InUnits, PhysicalModel
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from fscm.problem import Problem

__all__ = ["main"]

_OURS = Path(__file__).resolve().parent.parent
_LARGEST_CURVE = 1_000_000
_COUNTS = ("size", "iterations")
#: Attributes that every model has.
_TEXTS = ("name", "version", "citation", "domain")


def main(replies: int) -> None:
    """Serve requests until there are no more.

    Parameters
    ----------
    replies : int
        Descriptor to write replies to.
    """
    requests = os.fdopen(os.dup(0), "r", encoding="utf-8")
    null = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(null, stream)
    threading.Thread(target=_end_with_parent, args=(requests.fileno(),), daemon=True).start()
    with os.fdopen(replies, "w", encoding="utf-8") as out:
        _serve(requests, out)


def _end_with_parent(descriptor: int) -> None:
    """End this process when the parent has ended, also in the middle of a loop of the model.

    It removes nothing: a model can change every function that is called here (see `comparisons.external.scratch`).
    """
    poll = select.poll()
    poll.register(descriptor, 0)
    poll.poll()
    os._exit(0)


def _serve(requests: IO[str], out: IO[str]) -> None:
    model: Any = None
    limits = Limits()
    reply: dict[str, Any]
    for line in requests:
        request = json.loads(line)
        started = time.perf_counter()
        try:
            if request["request"] == "ready":
                limits, reply = Limits(**request["limits"]), {"status": "ok"}
                _confine(request["path"], limits)
            elif request["request"] == "load":
                model, reply = _load(request["source"])
            else:
                cpu_seconds_from_now(limits)
                reply = _HANDLERS[request["request"]](model, request)
        except NotApplicable as refusal:
            reply = {"status": "not-applicable", "reason": _words(refusal)}
        except BaseException as error:
            reply = {"status": "failed", "reason": _explain(error, limits, request["request"])}
        reply["seconds"] = time.perf_counter() - started
        out.write(json.dumps(reply, allow_nan=False) + "\n")
        out.flush()


def _confine(path: list[str], limits: Limits) -> None:
    limit_resources(limits)
    cpu_seconds_from_now(limits)
    sys.path[:] = path


def _load(source: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
    if source["kind"] == "file":
        file, installed = Path(source["file"]), []
        made, module = load_file(file, source["attribute"]), file.stem
    else:
        (found,) = {entry for entry in entry_points(group=source["group"]) if entry.name == source["name"]}
        made, module = found.load(), found.module
        files = found.dist.files if found.dist else None
        installed = [Path(str(path.locate())).resolve() for path in files or ()]
    model = made() if callable(made) else made
    cls = made if isinstance(made, type) else type(model)
    if missing := [name for name in _TEXTS if not hasattr(model, name)]:
        raise ComputationFailed(f"the model has no {', '.join(missing)}; it needs {', '.join(_TEXTS)}")
    limits = getattr(model, "limits", ())
    if not isinstance(limits, tuple | list | set | frozenset):
        raise ComputationFailed(
            f'limits = {_kind(limits)} is not a tuple of texts such as ("jkr",): it names where the model is exact'
        )
    state = fingerprint(
        (module, cls.__module__),
        getattr(model, "files", ()),
        installed=installed,
        skip=[(device, inode) for device, inode in source.get("skip", ())],
    )
    reply = {
        "status": "ok",
        **{name: str(getattr(model, name)) for name in _TEXTS},
        "limits": [str(limit) for limit in limits],
        "curve": callable(getattr(model, "curve", None)),
        "physical": isinstance(model, PhysicalModel),
        "digest": state.digest,
        "hashed": state.hashed,
    }
    if not reply["physical"] and not callable(getattr(model, "evaluate", None)):
        raise TypeError("the model has no method evaluate(problem, quantity)")
    return model, reply


def _evaluate(model: Any, request: dict[str, Any]) -> dict[str, Any]:
    if isinstance(model, PhysicalModel):
        model = InUnits(model, request["poisson_ratio"], request["scales"])
    result = model.evaluate(_problem(request), request["quantity"])
    if not isinstance(result, Result):
        raise ComputationFailed(f"the model returned {_kind(result)}, which is not a comparisons.model.Result")
    numbers_of = {name: _real(name, getattr(result, name)) for name in ("value", "u_num", "residual")}
    Result(numbers_of["value"], numbers_of["u_num"])
    return {"status": "ok", **numbers_of, **{name: _count(name, getattr(result, name)) for name in _COUNTS}}


def _curve(model: Any, request: dict[str, Any]) -> dict[str, Any]:
    curve = model.curve(_problem(request))
    if not isinstance(curve, Curve):
        raise ComputationFailed(f"the model returned {_kind(curve)}, which is not a comparisons.model.Curve")
    named = {"displacement": curve.displacement, "load": curve.load, **curve.columns}
    arrays = {one_line(str(name), 60): _array(str(name), array) for name, array in named.items()}
    lengths = {name: len(array) for name, array in arrays.items()}
    if len(set(lengths.values())) != 1:
        listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise ComputationFailed(f"the columns of the curve have different lengths: {listed}")
    return {"status": "ok", "columns": arrays}


_HANDLERS: dict[str, Callable[[Any, dict[str, Any]], dict[str, Any]]] = {
    "evaluate": _evaluate,
    "curve": _curve,
}


def _problem(request: dict[str, Any]) -> Problem:
    return Problem(request["n"], request["k"], request["mu"])


def _real(name: str, value: object) -> float:
    if isinstance(value, bool | np.bool_) or not isinstance(value, numbers.Real):
        raise ComputationFailed(f"the model gave {_kind(value)} as {name}, which is not a real number")
    number = float(value)
    if not math.isfinite(number):
        raise ComputationFailed(f"the model gave {number} as {name}, which is not a finite number")
    return number


def _count(name: str, value: object) -> int:
    """Return a count, as the stored tables have it."""
    number = int(_real(name, value))
    if not 0 <= number < LARGEST_COUNT:
        raise ComputationFailed(
            f"the model gave {_kind(value)} as {name}, which is outside [0, 2^63): it is a number of steps or unknowns"
        )
    return number


def _array(name: str, values: object) -> list[float]:
    array = np.asarray(values)
    if array.ndim != 1 or array.dtype.kind not in "fiu" or not 1 <= len(array) <= _LARGEST_CURVE:
        raise ComputationFailed(
            f"column {one_line(name, 60)} of the curve is {_kind(values)}, not 1 to {_LARGEST_CURVE} real numbers"
        )
    if not np.isfinite(array).all():
        raise ComputationFailed(f"column {one_line(name, 60)} of the curve has values that are not finite")
    return [float(value) for value in array]


def _kind(value: object) -> str:
    """Describe a value; of its own text at most one line."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} and type {value.dtype}"
    if isinstance(value, str | int | float | complex | None):
        return one_line(f"{type(value).__name__} {value!r}", 80)
    return f"an object of type {one_line(type(value).__name__, 60)}"


def _is_of_model(filename: str) -> bool:
    """Whether a line of a traceback is code of the model, not of this program."""
    return not filename.startswith("<") and not Path(filename).is_relative_to(_OURS)


def _words(thing: object, by: Callable[[object], str] = str) -> str:
    """Return the text of an exception; its class may be of the model, and the conversion may fail."""
    try:
        return one_line(by(thing))
    except BaseException as worse:
        return f"its text cannot be had: __{by.__name__}__ raises {type(worse).__name__}"


def _explain(error: BaseException, limits: Limits, request: str) -> str:
    """Return one line about a failure: the text of a `ComputationFailed`, else the error and its place in the code."""
    if isinstance(error, ComputationFailed):
        return _words(error) or "the model failed without a reason"
    name = type(error).__name__
    if isinstance(error, MemoryError):
        return f"MemoryError: the model needs more than its {limits.megabytes:g} MB"
    if isinstance(error, SystemExit):
        return f"SystemExit: the model called sys.exit({one_line(_words(error.code, repr), 60)})"
    if isinstance(error, SyntaxError) and error.lineno and error.filename and _is_of_model(error.filename):
        # It has no frame of its own: the place is in the exception.
        where = f"line {error.lineno} of {Path(error.filename).name}"
        return one_line(f"{type(error).__name__} in {where}: {error.msg}")
    every = traceback.extract_tb(error.__traceback__)
    # The place in the author's code, where for instance a Result was made of a text.
    frames = [frame for frame in every if _is_of_model(frame.filename)] or every
    place = f" in {frames[-1].name}, line {frames[-1].lineno} of {Path(frames[-1].filename).name}" if frames else ""
    # Loading a model involves no case.
    hint = (
        " (a case outside the domain is NotApplicable)" if isinstance(error, ValueError) and request != "load" else ""
    )
    return one_line(f"{name}{place}: {_words(error)}{hint}")
