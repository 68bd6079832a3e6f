"""The package that `new-model` writes: one model that works, its test, its gates and a workflow."""

from __future__ import annotations

import keyword
import os
import sys
from collections.abc import Collection
from importlib.resources import files
from pathlib import Path

from comparisons.external.text_rules import model_name

#: What the model or its tools import, or take for their own file, and would find beside the model instead.
_SHADOWED = {"comparisons", "fem_reference", "fscm", "numpy", "scipy", "pandas", "pytest", "setup", "conftest"}
#: Names that neither the module nor its class can have.
_TAKEN = {*_SHADOWED, "NotApplicable", "Result", *sys.stdlib_module_names, *keyword.kwlist}

#: Where each file of the template goes; MODULE is the name of the module.
_PLACES = {
    "pyproject.toml.in": "pyproject.toml",
    "model.py.in": "MODULE.py",
    "test_model.py.in": "test_MODULE.py",
    "gates.toml.in": "gates.toml",
    "README.md.in": "README.md",
    "judge.yml.in": ".github/workflows/judge.yml",
}


def write_template(folder: Path, reserved: Collection[str] = ()) -> tuple[list[Path], str]:
    """Write a new package; its model has the name of the folder.

    Parameters
    ----------
    folder : Path
        Made if it does not exist; it must be empty.
    reserved : collection of str, optional
        Names of models that exist already; the new one must have another.

    Returns
    -------
    list of Path
        The files.
    str
        The SPEC of the model in them.

    Raises
    ------
    ValueError
        If the folder is not empty, or its name cannot be that of a model or is reserved.
    OSError
        If it cannot be written.
    """
    name = model_name(Path(os.path.realpath(folder)).name)
    module = name.replace("-", "_").replace(".", "_").lower()
    cls = module.title().replace("_", "")
    taken = {module, cls} & _TAKEN or module in {model.replace("-", "_") for model in reserved}
    if taken or not module.isidentifier() or not name[-1].isalnum():
        raise ValueError(
            f"the folder's name {name} cannot be that of a model: a module {module} with a class {cls} cannot be "
            "imported or installed, or hides another; choose another name"
        )
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ValueError(f"{folder} exists and is not an empty folder")
    paths = []
    for source, target in _PLACES.items():
        text = files("comparisons.external").joinpath("template_files", source).read_text(encoding="utf-8")
        for word, meaning in (("@MODEL@", name), ("@MODULE@", module), ("@CLASS@", cls)):
            text = text.replace(word, meaning)
        paths.append(folder / target.replace("MODULE", module))
        paths[-1].parent.mkdir(parents=True, exist_ok=True)
        paths[-1].write_text(text, encoding="utf-8")
    return paths, f"{folder / module}.py:{cls}"
