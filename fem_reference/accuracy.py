"""Accuracies, and the meshes and degrees that they select."""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = ["ACCURACIES", "SEARCH_DEGREE", "Level", "coarser_accuracy", "finer_levels", "level_for", "relative_error"]

#: Names of accuracies. Measured for n = 2 and the 9-3 law: the pull-off force has these relative errors. The bound
#: `u_num` is larger: it is the sum of what other meshes show.
ACCURACIES = {"quick": 1e-6, "default": 1e-7, "fine": 1e-8}

#: Accuracies are below it: a relative error of one leaves no digit.
LARGEST = 1.0


@dataclass(frozen=True, slots=True)
class Level:
    """Degree of the elements, density of their mesh, and the relative error asked for.

    Examples
    --------
    >>> level_for("quick")
    Level(order=6, density=1.05, accuracy=1e-06)
    """

    order: int
    density: float
    accuracy: float


#: Degree of the elements on which a path is traced, an edge is measured and a feature of the mesh is judged: those of
#: the bound contain it, at a tenth of the cost.
SEARCH_DEGREE = 4

#: Degree, density and tolerance of the elements by relative error.
_LEVELS = {
    1e-6: Level(6, 1.05, 1e-6),
    1e-7: Level(8, 1.25, 1e-7),
    1e-8: Level(8, 0.8, 1e-8),
}


def relative_error(accuracy: float | str) -> float:
    """Check an accuracy and return the number it stands for.

    Examples
    --------
    >>> relative_error("quick")
    1e-06
    """
    finest = min(_LEVELS)
    choices = ", ".join(f"{name!r} ({number:g})" for name, number in ACCURACIES.items())
    if isinstance(accuracy, str):
        if accuracy not in ACCURACIES:
            raise ValueError(f"accuracy {accuracy!r} is unknown; choose one of {choices}, or a number")
        return ACCURACIES[accuracy]
    if isinstance(accuracy, bool) or not isinstance(accuracy, (int, float)) or not finest <= accuracy < LARGEST:
        raise ValueError(
            f"accuracy {accuracy!r} is outside [{finest:g}, {LARGEST:g}): it is the relative error asked for, and "
            f"finer meshes have not been verified; choose such a number, or one of {choices}"
        )
    return float(accuracy)


def level_for(accuracy: float | str) -> Level:
    """Return the meshes of an accuracy.

    Between two named accuracies the degree is that of the finer one, and the logarithm of the density is linear in that
    of the accuracy, but no element is shorter than those of the finer one.  Above the largest of them the meshes are
    those of "quick": a path cannot be traced reliably on coarser ones.

    Parameters
    ----------
    accuracy : float or str
        Relative error asked for, in [1e-8, 1), or one of `ACCURACIES`.

    Raises
    ------
    ValueError
        For an unknown name or a number outside the range.

    Examples
    --------
    >>> level_for(1e-7) == level_for("default")
    True
    >>> level_for(3e-8).order, round(level_for(3e-8).density, 3)
    (8, 0.99)
    """
    number = min(relative_error(accuracy), max(_LEVELS))
    if number in _LEVELS:
        return _LEVELS[number]
    larger, smaller = min(n for n in _LEVELS if n > number), max(n for n in _LEVELS if n < number)
    share = math.log(larger / number) / math.log(larger / smaller)
    coarse, fine = _LEVELS[larger], _LEVELS[smaller]
    between = coarse.density * (fine.density / coarse.density) ** share
    return Level(fine.order, max(between, fine.density), number)


def coarser_accuracy(accuracy: float | str) -> tuple[float, str] | None:
    """Return an accuracy finer than "default" as a number, and the name of the next coarser one; None for others.

    Examples
    --------
    >>> coarser_accuracy("fine"), coarser_accuracy("default")
    ((1e-08, 'default'), None)
    """
    number = relative_error(accuracy)
    return (number, "default") if number < ACCURACIES["default"] else None


def finer_levels(accuracy: float | str) -> list[Level]:
    """Return the meshes of an accuracy, then those of the finer named accuracies.

    Examples
    --------
    >>> finer_levels("default") == [level_for("default"), level_for("fine")]
    True
    """
    number = min(relative_error(accuracy), max(_LEVELS))
    return [level_for(number), *(_LEVELS[n] for n in sorted(_LEVELS, reverse=True) if n < number)]
