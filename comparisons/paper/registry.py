"""Registry of the figures of the paper and of the studies beyond it.

A figure is a statement ``FIGURE = PaperFigure(name="9", ...)`` at the top level of a module in `FOLDERS`, with its name
as the first argument.  The registry finds these statements in the sources, so that a new figure is one new module, and
a module is imported only when one of its figures is needed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from importlib import import_module
from importlib.resources import files

from comparisons.paper.paper_figure import PaperFigure

__all__ = ["FOLDERS", "NAMES", "paper_figures"]

#: Folders of modules with figures, in the order of `NAMES`.
FOLDERS = ("figures", "values", "statements", "findings", "studies")

_STATEMENT = re.compile(r'^(\w+) = PaperFigure\(\s*name="([^"]+)"', flags=re.MULTILINE)


def _places() -> dict[str, tuple[str, str]]:
    """Return the module and the variable of every figure, by name."""
    found: dict[str, tuple[str, str]] = {}
    for folder in FOLDERS:
        package = f"comparisons.paper.{folder}"
        sources = (file for file in files(package).iterdir() if file.name.endswith(".py"))
        for file in sorted(sources, key=lambda file: file.name):
            module = f"{package}.{file.name.removesuffix('.py')}"
            for variable, name in _STATEMENT.findall(file.read_text(encoding="utf-8")):
                if name in found:
                    raise ValueError(f"two figures have the name {name!r}: in {found[name][0]} and in {module}")
                found[name] = module, variable
    # Figures of the paper by their number, then the others in the order of their modules.
    return dict(sorted(found.items(), key=lambda item: int(item[0]) if item[0].isdigit() else len(found)))


_PLACES = _places()

#: Values of `--figure`: the numbers of the paper's figures, then the names of what is not a figure of the paper.
NAMES = tuple(_PLACES)


def paper_figures(names: Iterable[str] | None = None) -> list[PaperFigure]:
    """Return the figures of these names, by default all, in the order of `NAMES`.

    Raises
    ------
    ValueError
        If there is no figure of a name; the sentence lists those that exist.

    Examples
    --------
    >>> [figure.title for figure in paper_figures(["10"])]
    ['Pull-off force from the Bradley to the JKR limit']
    """
    wanted = set(NAMES if names is None else names)
    unknown = sorted(wanted.difference(NAMES))
    if unknown:
        raise ValueError(f"there is no figure {unknown[0]!r}; there are {', '.join(NAMES)}")
    return [getattr(import_module(module), variable) for name, (module, variable) in _PLACES.items() if name in wanted]
