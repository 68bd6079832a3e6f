"""Program of the child process, which loads one external model and evaluates it, one JSON object a line.

Requests come on what was stdin; replies go to a descriptor of their own.  Before any code of the model runs,
stdin, stdout and stderr are redirected to the null device, so a model may print what it likes.
"""

from __future__ import annotations

import json
import os
import select
import sys
import threading
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

from comparisons.domain import declared_domain
from comparisons.external.fingerprint import fingerprint
from comparisons.external.limits import Limits, cpu_seconds_from_now, limit_resources
from comparisons.external.model_file import load_file
from comparisons.external.model_methods import check_methods
from comparisons.external.physical_model import InUnits, PhysicalModel
from comparisons.external.program import program_model
from comparisons.external.reply_checks import column, count, kind, real
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from fscm.problem import Problem

__all__ = ["main"]

_OURS = Path(__file__).resolve().parent.parent
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
    modules: tuple[str, ...] = ()
    installed: list[Path] = []
    programs: list[Path] = []
    if source["kind"] == "program":
        model = program_model(Path(source["file"]))
        programs = [Path(source["file"])]
    else:
        made, module, installed = _made(source)
        model = made() if callable(made) else made
        modules = module, (made if isinstance(made, type) else type(model)).__module__
    if missing := [name for name in _TEXTS if not hasattr(model, name)]:
        raise ComputationFailed(f"the model has no {', '.join(missing)}; it needs {', '.join(_TEXTS)}")
    limits = getattr(model, "limits", ())
    if not isinstance(limits, tuple | list | set | frozenset):
        raise ComputationFailed(
            f'limits = {kind(limits)} is not a tuple of texts such as ("jkr",): it names where the model is exact'
        )
    domain = declared_domain(model)
    state = fingerprint(
        modules,
        getattr(model, "files", ()),
        installed=installed,
        programs=programs,
        skip=[(device, inode) for device, inode in source.get("skip", ())],
    )
    reply = {
        "status": "ok",
        **{name: str(getattr(model, name)) for name in _TEXTS},
        "limits": [str(limit) for limit in limits],
        "applies_to": None if domain is None else domain.as_json(),
        "curve": callable(getattr(model, "curve", None)),
        "physical": isinstance(model, PhysicalModel),
        "digest": state.digest,
        "hashed": state.hashed,
    }
    check_methods(model, isinstance(model, PhysicalModel))
    return model, reply


def _made(source: dict[str, Any]) -> tuple[Any, str, list[Path]]:
    """Return what a file or an entry point defines, the name of its module, and the files installed with it."""
    if source["kind"] == "file":
        file = Path(source["file"])
        return load_file(file, source["attribute"]), file.stem, []
    # It takes a tenth of the start of a process, and a file does not need it.
    from importlib.metadata import entry_points

    (found,) = {entry for entry in entry_points(group=source["group"]) if entry.name == source["name"]}
    made = found.load()
    files = found.dist.files if found.dist else None
    return made, found.module, [Path(str(path.locate())).resolve() for path in files or ()]


def _evaluate(model: Any, request: dict[str, Any]) -> dict[str, Any]:
    if isinstance(model, PhysicalModel):
        model = InUnits(model, request["poisson_ratio"], request["scales"])
    result = model.evaluate(_problem(request), request["quantity"])
    if not isinstance(result, Result):
        raise ComputationFailed(f"the model returned {kind(result)}, which is not a comparisons.model.Result")
    numbers_of = {name: real(name, getattr(result, name)) for name in ("value", "u_num", "residual")}
    Result(numbers_of["value"], numbers_of["u_num"])
    return {"status": "ok", **numbers_of, **{name: count(name, getattr(result, name)) for name in _COUNTS}}


def _curve(model: Any, request: dict[str, Any]) -> dict[str, Any]:
    curve = model.curve(_problem(request))
    if not isinstance(curve, Curve):
        raise ComputationFailed(f"the model returned {kind(curve)}, which is not a comparisons.model.Curve")
    named = {"displacement": curve.displacement, "load": curve.load, **curve.columns}
    arrays = {one_line(str(name), 60): column(str(name), array) for name, array in named.items()}
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
