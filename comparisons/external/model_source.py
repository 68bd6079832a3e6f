"""Sources of external models: a package, a file, a program or data, and the model that a SPEC names.

NAME                 package: an entry point of the group `fscm_bench.models` of an installed package
FILE.py:CLASS        file: a local Python file
./PROGRAM            program: an executable that speaks JSON lines (`comparisons.external.program`)
FOLDER               data: predictions in a folder with a `model.toml`

A name that is both an entry point and a folder with a `model.toml` is refused; with a separator (./NAME) it is
the folder.
"""

from __future__ import annotations

import atexit
import os
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

from comparisons.external.data_model import MANIFEST, DataModel
from comparisons.external.inherited import hidden_folders
from comparisons.external.installed import GROUP
from comparisons.external.process_model import ExternalModel, connect
from comparisons.external.text_rules import one_line

#: A model of the user: a class or program, or a table of data.
AnyExternalModel = ExternalModel | DataModel


_SPECS = f"an installed model, FILE.py:CLASS, a program (./PROGRAM) or a folder with a {MANIFEST}"

_loaded: dict[str, AnyExternalModel] = {}


def source_of(spec: str) -> dict[str, Any]:
    """Return the source of a model: its kind, and how a worker finds it or where its folder is.

    Raises
    ------
    ValueError
        If there is no such source, or more than one; the sentence lists what a SPEC can be.

    Examples
    --------
    >>> source_of("nothing-of-this-name")
    Traceback (most recent call last):
    ...
    ValueError: no installed package has a model 'nothing-of-this-name' ...
    """
    if not spec.strip():
        raise ValueError(f"the name of a model, {spec!r}, is empty: name {_SPECS}")
    quoted = one_line(spec, 200)
    file, _, attribute = spec.rpartition(":")
    if file.endswith(".py"):
        # Not Path.resolve(), which raises RuntimeError at a loop of symbolic links.
        path = os.path.realpath(os.path.expanduser(file))
        if not os.path.isfile(path):
            raise ValueError(f"there is no file {one_line(file, 200)}")
        if not attribute.isidentifier():
            raise ValueError(f"{quoted}: the text after the colon must be the name of a class")
        return {"kind": "file", "file": path, "attribute": attribute}
    path = os.path.realpath(os.path.expanduser(spec))
    folder = os.path.dirname(path) if os.path.basename(path) == MANIFEST else path
    data = os.path.isfile(os.path.join(folder, MANIFEST))
    # Without a separator it is a name, as for a shell.
    if os.path.isfile(path) and not data and os.sep in spec:
        if not os.access(path, os.X_OK):
            raise ValueError(
                f"{quoted} is a file that is no program: make it executable (chmod +x), name the class of a file in "
                f"Python (FILE.py:CLASS), or put a table into a folder with a {MANIFEST}"
            )
        return {"kind": "program", "file": path}
    count = 0 if os.sep in spec else len({entry for entry in entry_points(group=GROUP) if entry.name == spec})
    if data and count:
        raise ValueError(
            f"{spec!r} is both a folder with a {MANIFEST} and a model of an installed package: "
            f"name the folder .{os.sep}{spec}, or use the package from another working folder"
        )
    if data:
        return {"kind": "data", "folder": folder}
    if count > 1:
        raise ValueError(f"{count} installed packages have a model {spec!r}; name it FILE.py:CLASS instead")
    # A folder without predictions hides no entry point: a package is often installed from a folder of its name.
    if count == 0:
        raise ValueError(f"no installed package has a model {quoted!r} (entry points of group {GROUP}); name {_SPECS}")
    return {"kind": "package", "group": GROUP, "name": spec}


def load_model(spec: str) -> AnyExternalModel:
    """Return the model that a SPEC names; loaded once in a process and kept.

    Parameters
    ----------
    spec : str
        See the module's text.

    Raises
    ------
    ValueError
        If there is none, or it does not load; the sentence has the reason.
    """
    # A process that has started cannot lose what it may read.
    key = repr((source_of(spec), hidden_folders()))
    if key not in _loaded:
        _loaded[key] = load_again(spec)
    return _loaded[key]


def load_again(spec: str) -> AnyExternalModel:
    """Return the model that a SPEC names in a process of its own, which the caller closes.

    Raises
    ------
    ValueError
        As `load_model`.
    """
    source = source_of(spec)
    return DataModel(Path(source["folder"])) if source["kind"] == "data" else connect(source, spec)


@atexit.register
def close_models() -> None:
    """End the child processes of all models that are loaded."""
    for model in _loaded.values():
        model.close()
    _loaded.clear()
