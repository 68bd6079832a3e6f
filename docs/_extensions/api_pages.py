"""Pages of the API reference: every public name of the three packages, from the docstrings.

A page for each package has the names that stand in the package itself.  A page for each folder has the names of its
modules that are not on the page of the package.  The pages are written before Sphinx reads the documents.
"""

from __future__ import annotations

import ast
import re
import shutil
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from inspect import isclass, isroutine
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_origin

from api_start import table
from api_texts import PACKAGES, ROOT, texts_of

from comparisons.runs.environment import NOT_INSTALLED

if TYPE_CHECKING:
    from sphinx.application import Sphinx

#: Folder of the pages, relative to the documents.
FOLDER = "_generated/api"
_LEFT_OUT = (*NOT_INSTALLED, Path("comparisons/cli/commands"))


@cache
def exported(package: str) -> list[str]:
    """Public names of a package itself.

    Examples
    --------
    >>> "solve" in exported("fscm")
    True
    """
    return sorted(set(import_module(package).__all__), key=str.lower)


def modules(package: str) -> list[str]:
    """Public modules of a package: no part of their name begins with an underscore, and they have public names.

    Folders that are not installed are left out, and the commands, which are read as text.

    Examples
    --------
    >>> "fscm.experiment" in modules("fscm"), "fscm._surface.kernel" in modules("fscm")
    (True, False)
    >>> "comparisons.start_entry" in modules("comparisons")
    False
    """
    found = []
    for path in sorted((ROOT / package).rglob("*.py")):
        if any(path.is_relative_to(ROOT / folder) for folder in _LEFT_OUT):
            continue
        name = _module_of(path)
        if not any(part.startswith("_") for part in name.split(".")) and public_names(path):
            found.append(name)
    return [name for name in found if name != package]


def _module_of(path: Path) -> str:
    return ".".join(part for part in path.relative_to(ROOT).with_suffix("").parts if part != "__init__")


@cache
def public_names(path: Path) -> list[str]:
    """The literal `__all__` of a module, or what it defines with a text and without an underscore before its name.

    The module is read without importing it.
    """
    body = ast.parse(path.read_text(encoding="utf-8")).body
    for statement in body:
        match statement:
            case ast.Assign(targets=[ast.Name(id="__all__")], value=ast.List(elts=elements)):
                return [str(element.value) for element in elements if isinstance(element, ast.Constant)]
    defined = [one for one in body if isinstance(one, ast.FunctionDef | ast.ClassDef) and ast.get_docstring(one)]
    named = [*(one.name for one in defined), *(name for name, text in texts_of(path, imported=False).items() if text)]
    return sorted(name for name in named if not name.startswith("_"))


def names_of(module: str) -> list[str]:
    """Public names of a module that its package does not have itself."""
    package = module.partition(".")[0]
    path = ROOT / Path(*module.split("."))
    names = public_names(path / "__init__.py" if path.is_dir() else path.with_suffix(".py"))
    # A name that the package has is on its page.
    there, here = import_module(package), import_module(module)
    return [name for name in names if not (name in exported(package) and getattr(there, name) is getattr(here, name))]


def pages() -> Iterator[tuple[str, str]]:
    """Name and content of every page of the reference."""
    folders = []
    for package in PACKAGES:
        entries = [_entry(package, name) for name in exported(package)]
        text = f"{_heading(package, '=')}.. automodule:: {package}\n   :no-members:\n   :no-index:\n\n"
        yield package, text + "\n".join(entries)
        by_folder = sorted((_folder(name), name) for name in modules(package))
        for folder, members in groupby(by_folder, key=lambda pair: pair[0]):
            page = "".join(_module(name) for _, name in members)
            if page:
                title = f"Modules of {folder}"
                yield f"modules.{folder}", f"{_heading(title, '=')}{page}"
                folders.append(f"modules.{folder}")
    listed = "\n   ".join([*PACKAGES, *folders])
    text = (
        "The names of the three packages, and below them the modules behind them.  "
        "A module whose name begins with an underscore is private and may change.\n\n"
    )
    start = "These names are enough for most work.  The classes of `fscm` have the same names in `fem_reference`.\n\n"
    start += f"{table()}\n"
    yield "index", f"{_heading('API reference', '=')}{start}{text}.. toctree::\n   :maxdepth: 1\n\n   {listed}\n"


def _folder(module: str) -> str:
    """The folder of a module: the package, or a folder directly in it."""
    parts = module.split(".")
    inner = (ROOT / parts[0] / parts[1]).is_dir()
    return ".".join(parts[:2]) if inner else parts[0]


def _heading(text: str, line: str) -> str:
    return f"{text}\n{line * len(text)}\n\n"


def _module(name: str) -> str:
    names = names_of(name)
    if not names:
        return ""
    text = f"{_heading(name, '-')}.. automodule:: {name}\n   :no-members:\n\n"
    return text + "\n".join(_entry(name, one) for one in names) + "\n"


def _entry(place: str, name: str) -> str:
    """The directive of a name; data have the comment that begins with ``#:`` before them."""
    value = getattr(import_module(place), name)
    # An alias such as dict[str, float] is data, though Python takes it for a class.
    if isclass(value) and get_origin(value) is None:
        return f".. autoclass:: {place}.{name}\n   :members:\n"
    if isroutine(value):
        return f".. autofunction:: {place}.{name}\n"
    return f".. py:data:: {place}.{name}\n\n   {comment(place, name) or type(value).__name__}\n"


def comment(place: str, name: str) -> str:
    """The text on data: that at their definition or the title of a figure."""
    value = getattr(import_module(place), name)
    folder = ROOT / Path(*place.split("."))
    for path in sorted(folder.rglob("*.py")) if folder.is_dir() else [folder.with_suffix(".py")]:
        # Modules of a package may give the same name to different data.
        if (text := texts_of(path).get(name, "")) and getattr(import_module(_module_of(path)), name) is value:
            return escaped(text)
    title = getattr(value, "title", "")
    if isinstance(title, str) and title:
        return escaped(f"{type(value).__name__} `{value.name}`: {title}.")
    return ""


def escaped(line: str) -> str:
    r"""A line in which bars and underscores at the end of a word are no markup, but for what is between backticks.

    Examples
    --------
    >>> escaped("|H| is `u_`, and u_ too")
    '\\|H\\| is `u_`, and u\\_ too'
    """
    parts = re.split(r"(`+[^`]*`+)", line)
    parts[::2] = [re.sub(r"(?<=\w)_(?!\w)|\|", r"\\\g<0>", part) for part in parts[::2]]
    return "".join(parts)


def _escape(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Escape the lines of a docstring that are not part of an example."""
    example = False
    for number, line in enumerate(lines):
        example = line.lstrip().startswith(">>>") or (example and bool(line.strip()))
        if not example:
            lines[number] = escaped(line)


def write(docs: Path) -> None:
    """Write the pages into the folder of the documents; unchanged pages keep their time."""
    folder = docs / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    content = {f"{name}.rst": text for name, text in pages()}
    for path in folder.iterdir():
        if path.name not in content:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    for name, text in content.items():
        path = folder / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages before the documents are read."""
    app.connect("builder-inited", lambda app: write(Path(app.srcdir)))
    # Before numpydoc adds markup of its own.
    app.connect("autodoc-process-docstring", _escape, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
