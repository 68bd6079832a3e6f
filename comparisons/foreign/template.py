"""What `new-model` writes: a package with one model that works, its test, and a workflow that gates it."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from comparisons.foreign.wording import model_name
from comparisons.models import MODELS

__all__ = ["write_template"]

#: Where each file of the template goes; MODULE is the name of the module.
_PLACES = {
    "pyproject.toml.in": "pyproject.toml",
    "model.py.in": "MODULE.py",
    "test_model.py.in": "test_MODULE.py",
    "gates.toml.in": "gates.toml",
    "README.md.in": "README.md",
    "judge.yml.in": ".github/workflows/judge.yml",
}


def write_template(folder: Path) -> tuple[list[Path], str]:
    """Write a new package; its model has the name of the folder.

    Parameters
    ----------
    folder : Path
        Made if it does not exist; it must be empty.

    Returns
    -------
    list of Path
        The files.
    str
        The SPEC of the model in them.

    Raises
    ------
    ValueError
        If the folder is not empty, its name cannot be that of a model or is that of one of ours, or nothing can be
        written there.
    """
    name = model_name(folder.resolve().name)
    if name in MODELS:
        raise ValueError(f"{name} is the name of one of our models; choose another for the folder and its model")
    module = name.replace("-", "_").replace(".", "_").lower()
    if not module.isidentifier():
        raise ValueError(f"the folder's name {name} begins with a digit: no Python module can be called that")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ValueError(f"{folder} exists and is not an empty folder")
    words = {"MODEL": name, "MODULE": module, "CLASS": "".join(part.title() for part in module.split("_"))}
    written = []
    try:
        for source, place in _PLACES.items():
            text = files("comparisons.foreign").joinpath("template_files", source).read_text(encoding="utf-8")
            target = folder / place.replace("MODULE", module)
            target.parent.mkdir(parents=True, exist_ok=True)
            for word, meaning in words.items():
                text = text.replace(f"@{word}@", meaning)
            target.write_text(text, encoding="utf-8")
            written.append(target)
    except OSError as error:
        raise ValueError(f"{folder} cannot be written ({error.strerror})") from None
    return written, f"{folder / module}.py:{words['CLASS']}"
