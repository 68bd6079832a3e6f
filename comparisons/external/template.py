"""The package that `new-model` writes: one model that works, its test, its gates and a workflow."""

from __future__ import annotations

import keyword
import os
import sys
from collections.abc import Collection
from importlib.resources import files
from pathlib import Path

from comparisons.console.exit_status import full_disk
from comparisons.external.text_rules import model_name

#: What the model or its tools import, or take for their own file, and would find beside the model instead.
_SHADOWED = {"comparisons", "fem_reference", "fscm", "numpy", "scipy", "pandas", "pytest", "setup", "conftest"}
_IMPORTED = {"NotApplicable", "Result"}

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
        If the folder is not empty, its name cannot be that of a model or is reserved, or nothing can be written
        there.
    OSError
        If the disk is full.
    """
    name = model_name(Path(os.path.realpath(folder)).name)
    module = name.replace("-", "_").replace(".", "_").lower()
    cls = "".join(word.title() for word in module.split("_"))
    taken = _SHADOWED | sys.stdlib_module_names | {model.replace("-", "_") for model in reserved}
    hidden = module in taken or cls in _IMPORTED
    if hidden or not module.isidentifier() or {module, cls} & set(keyword.kwlist) or not name[-1].isalnum():
        raise ValueError(
            f"the folder's name {name} cannot be that of a model: a module {module} with a class {cls} cannot be "
            "imported or installed, or hides another; choose another name"
        )
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ValueError(f"{folder} exists and is not an empty folder")
    words = {"MODEL": name, "MODULE": module, "CLASS": cls}
    try:
        written = [_written(folder, source, target, words) for source, target in _PLACES.items()]
    except OSError as error:
        if full_disk(error):
            raise OSError(f"{folder} cannot be written ({error.strerror})") from error
        raise ValueError(f"{folder} cannot be written ({error.strerror})") from None
    return written, f"{folder / module}.py:{cls}"


def _written(folder: Path, source: str, target: str, words: dict[str, str]) -> Path:
    text = files("comparisons.external").joinpath("template_files", source).read_text(encoding="utf-8")
    path = folder / target.replace("MODULE", words["MODULE"])
    path.parent.mkdir(parents=True, exist_ok=True)
    for word, meaning in words.items():
        text = text.replace(f"@{word}@", meaning)
    path.write_text(text, encoding="utf-8")
    return path
