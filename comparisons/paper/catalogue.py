"""Every plate, in the order of the paper.  To add one: write its module and add its name here."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module

from comparisons.paper.plate import Plate

__all__ = ["NAMES", "plates"]

#: name -> "module:plate"; a module is imported only when its plate is asked for.
_PLATES = {
    "2": "comparisons.paper.kernel_functions:KERNEL_FUNCTIONS",
}

#: What `--figure` takes: the numbers of the paper's figures, then what is not in the paper.
NAMES = tuple(_PLATES)


def plates(names: Iterable[str] | None = None) -> list[Plate]:
    """Return the plates of these names, by default all, in the order of the catalogue.

    Raises
    ------
    ValueError
        If there is no plate of a name; the sentence lists those that exist.
    """
    wanted = set(NAMES if names is None else names)
    unknown = sorted(wanted.difference(NAMES))
    if unknown:
        raise ValueError(f"there is no figure {unknown[0]!r}; there are {', '.join(NAMES)}")
    found = []
    for name in NAMES:
        if name in wanted:
            module, _, attribute = _PLATES[name].partition(":")
            found.append(getattr(import_module(module), attribute))
    return found
