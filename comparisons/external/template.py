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

__all__ = ["write_template"]

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
    cls = "".join(part.title() for part in module.split("_"))
    if why := _unusable(name, module, cls, reserved):
        raise ValueError(f"the folder's name {name} {why}; choose another")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ValueError(f"{folder} exists and is not an empty folder")
    words = {"MODEL": name, "MODULE": module, "CLASS": cls}
    written = []
    try:
        for source, place in _PLACES.items():
            text = files("comparisons.external").joinpath("template_files", source).read_text(encoding="utf-8")
            target = folder / place.replace("MODULE", module)
            target.parent.mkdir(parents=True, exist_ok=True)
            for word, meaning in words.items():
                text = text.replace(f"@{word}@", meaning)
            target.write_text(text, encoding="utf-8")
            written.append(target)
    except OSError as error:
        if full_disk(error):
            raise OSError(f"{folder} cannot be written ({error.strerror})") from error
        raise ValueError(f"{folder} cannot be written ({error.strerror})") from None
    return written, f"{folder / module}.py:{words['CLASS']}"


def _unusable(name: str, module: str, cls: str, reserved: Collection[str]) -> str:
    """Return why a package of that name would not work; nothing if it would."""
    if module in {model.replace("-", "_") for model in reserved}:
        return "is that of a model of fscm-bench"
    if not name[-1].isalnum():
        return "ends in a sign: no package can be installed under it"
    if not module.isidentifier():
        return "begins with a digit: no Python module can be called that"
    if keyword.iskeyword(module) or keyword.iskeyword(cls):
        return "is a word of the Python language"
    if module in _SHADOWED | sys.stdlib_module_names:
        return f"would make a module {module}.py, which hides another of that name"
    if cls in _IMPORTED:
        return f"would make a class {cls}, which hides what the template imports"
    return ""
