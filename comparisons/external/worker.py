"""Program of the process of a model in Python, which loads the model and evaluates it, one JSON object a line.

It has the protocol of a program in any language (docs/judge_your_model.md). Before any code of the model runs, stdin,
stdout and stderr are redirected to the null device, so a model may print what it likes.
"""

from __future__ import annotations

import json
import numbers
import os
import sys
import traceback
from collections.abc import Iterable
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.domain import declared_domain
from comparisons.external.fingerprint import SITES
from comparisons.external.text_rules import TEXTS, one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from fscm.problem import Problem

#: Packages of this program, which has a version of its own.
_OURS = ("comparisons", "fscm", "fem_reference")
_FOLDER = Path(__file__).resolve().parents[1]


def serve(source: dict[str, Any], megabytes: float) -> None:
    """Serve requests until there are no more.

    Parameters
    ----------
    source : dict
        How the model is found.
    megabytes : float
        Its limit of memory.
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
            if loading:
                model, files = _loaded(source)
                reply = _description(model, files)
            else:
                reply = {"evaluate": _evaluated, "curve": _curve}[request["request"]](model, request)
            text = _encoded({"status": "ok"} | reply)
        except NotApplicable as refusal:
            text = json.dumps({"status": "not-applicable", "reason": _text_of(refusal)})
        except BaseException as error:
            text = json.dumps({"status": "failed", "reason": _explain(error, megabytes, loading)})
        replies.write(text + "\n")
        replies.flush()


def _encoded(reply: dict[str, Any]) -> str:
    try:
        return json.dumps(reply, allow_nan=False, default=_plain)
    except ValueError:
        raise ComputationFailed("the model gave a number that is not finite") from None


def _plain(value: object) -> object:
    """Return a number or an array of NumPy as JSON has it."""
    if isinstance(value, np.ndarray) and value.ndim > 0:
        return value.tolist()
    if isinstance(value, numbers.Real) and not isinstance(value, np.bool_):
        return float(value)
    raise ComputationFailed(one_line(f"the model gave a {type(value).__name__} in place of a number, a text or a list"))


def _attributes(value: object, cls: type, names: Iterable[str]) -> dict[str, Any]:
    """Return what is sent of a result; refuse one of another class."""
    if not isinstance(value, cls):
        raise ComputationFailed(one_line(f"the model returned a {type(value).__name__}, not a {cls.__name__}"))
    return {name: getattr(value, name) for name in names}


def _loaded(source: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
    """Return the model, and where its files are: folders with the file that was loaded in each, and other files."""
    installed: Iterable[str] = ()
    if source["kind"] == "file":
        file = Path(source["file"])
        loaded, roots = _attribute_of_file(file, source["attribute"]), {str(file.parent): str(file)}
    else:
        # It takes a tenth of the start of a process, and a file does not need it.
        from importlib.metadata import entry_points

        (entry,) = {entry for entry in entry_points(group=source["group"]) if entry.name == source["name"]}
        loaded, roots = entry.load(), _root_of(entry.module)
        installed = (os.path.realpath(path.locate()) for path in (entry.dist.files if entry.dist else None) or ())
    model = loaded() if callable(loaded) else loaded
    roots = _root_of(type(model).__module__) | roots
    modules = (os.path.realpath(getattr(module, "__file__", None) or "/") for module in list(sys.modules.values()))
    imported = (name for name in modules if not any(f"/{site}/" in name for site in SITES))
    return model, {"roots": roots, "loaded": sorted({*installed, *imported})}


def _root_of(module: str) -> dict[str, str]:
    """Return the folder of a module or of its package, and its file; nothing for one of Python or of this program."""
    top = module.partition(".")[0]
    file = getattr(sys.modules.get(module), "__file__", None)
    if file is None or top in sys.stdlib_module_names or top in _OURS:
        return {}
    # A namespace package has no file of its own.
    package = getattr(sys.modules[top], "__file__", None) or file
    return {os.path.dirname(os.path.realpath(package)): os.path.realpath(file)}


def _attribute_of_file(file: Path, attribute: str) -> Any:
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


def _description(model: Any, files: dict[str, Any]) -> dict[str, Any]:
    needed = (*TEXTS, "evaluate")
    missing = [name for name in TEXTS if not hasattr(model, name)]
    if not callable(getattr(model, "evaluate", None)):
        missing.append("evaluate")
    if missing:
        raise ComputationFailed(f"the model has no {', '.join(missing)}; it needs {', '.join(needed)}")
    domain = declared_domain(model)
    limits = getattr(model, "limits", ())
    return {
        **{name: str(getattr(model, name)) for name in TEXTS},
        "limits": sorted(limits) if isinstance(limits, set | frozenset) else limits,
        "files": getattr(model, "files", ()),
        "applies_to": None if domain is None else domain.as_json(),
        "curve": callable(getattr(model, "curve", None)),
        "python": files,
    }


def _evaluated(model: Any, request: dict[str, Any]) -> dict[str, Any]:
    result = model.evaluate(_problem(request), request["quantity"])
    return _attributes(result, Result, ("value", "u_num", "residual", "size", "iterations"))


def _curve(model: Any, request: dict[str, Any]) -> dict[str, Any]:
    return _attributes(model.curve(_problem(request)), Curve, ("displacement", "load", "columns"))


def _problem(request: dict[str, Any]) -> Problem:
    return Problem(request["n"], request["k"], request["mu"])


def _is_of_model(filename: str) -> bool:
    """Whether a line of a traceback is code of the model, not of this program."""
    return not filename.startswith("<") and not Path(filename).is_relative_to(_FOLDER)


def _text_of(error: BaseException) -> str:
    """Return the text of an exception; its class may be of the model, and the conversion may fail."""
    try:
        return one_line(str(error))
    except BaseException as worse:
        return f"its text cannot be had: __str__ raises {type(worse).__name__}"


def _explain(error: BaseException, megabytes: float, loading: bool) -> str:
    """Return one line about a failure: the text of a `ComputationFailed`, else the error and its place in the code."""
    if isinstance(error, ComputationFailed):
        return _text_of(error)
    if isinstance(error, MemoryError):
        return f"MemoryError: the model needs more than its {megabytes:g} MB"
    # The place in the author's code, where for instance a Result was made of a text.
    all_frames = traceback.extract_tb(error.__traceback__)
    frames = [frame for frame in all_frames if _is_of_model(frame.filename)] or all_frames
    position = f" in {frames[-1].name}, line {frames[-1].lineno} of {Path(frames[-1].filename).name}" if frames else ""
    # Loading a model involves no case.
    hint = " (a case outside the domain is NotApplicable)" if isinstance(error, ValueError) and not loading else ""
    return one_line(f"{type(error).__name__}{position}: {_text_of(error)}{hint}")
