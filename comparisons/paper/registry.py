"""Registry of the figures of the paper and of the findings: a new module in the folder `figures` is enough."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from pkgutil import iter_modules

from comparisons.paper import figures
from comparisons.paper import printed_values as printed_values
from comparisons.paper.paper_figure import FIGURES, PaperFigure
from comparisons.paper.statements import judgement as judgement

for _module in iter_modules(figures.__path__, f"{figures.__name__}."):
    import_module(_module.name)

#: Values of `--figure`: the numbers of the paper's figures, then the names of what is not a figure of the paper.
NAMES = tuple(sorted(FIGURES, key=lambda name: (int(name) if name.isdigit() else len(FIGURES), name)))


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
    return [FIGURES[name] for name in NAMES if name in wanted]
