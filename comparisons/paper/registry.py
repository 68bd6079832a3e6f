"""Every figure, in the order of the paper.  To add one: write its module and add its name here."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module

from comparisons.paper.paper_figure import PaperFigure

__all__ = ["NAMES", "paper_figures"]

#: name -> "module:figure"; a module is imported only when its figure is asked for.
_PLATES = {
    "1": "comparisons.paper.figures.sketch:SKETCH",
    "2": "comparisons.paper.figures.kernel_functions:KERNEL_FUNCTIONS",
    "3": "comparisons.paper.figures.s_curve:S_CURVE",
    "4": "comparisons.paper.figures.force_curves:OVER_TABOR_NUMBERS",
    "5": "comparisons.paper.figures.pull_off_surfaces:OVER_TABOR_NUMBERS",
    "6": "comparisons.paper.figures.force_curves:OVER_GRADIENTS",
    "7": "comparisons.paper.figures.pull_off_surfaces:OVER_GRADIENTS",
    "8": "comparisons.paper.figures.jumps:JUMPS",
    "9": "comparisons.paper.figures.jump_asymptotes:JUMP_ASYMPTOTES",
    "10": "comparisons.paper.figures.transition:TRANSITION",
    "11": "comparisons.paper.figures.gradient_effect:GRADIENT_EFFECT",
    "12": "comparisons.paper.figures.surface_laws:SURFACE_LAWS",
    "13": "comparisons.paper.figures.force_curve_models:FORCE_CURVE_MODELS",
    "14": "comparisons.paper.figures.pull_off_models:PULL_OFF",
    "15": "comparisons.paper.figures.pull_off_models:PULL_OFF_BY_RIGID_LIMIT",
    "16": "comparisons.paper.figures.pull_off_models:PULL_OFF_BY_SOFT_LIMIT",
    "17": "comparisons.paper.figures.surface_models:SURFACE_MODELS",
    "numbers": "comparisons.paper.values.comparison:PAPER_VALUES",
    "error-maps-shape": "comparisons.paper.studies.error_maps:ERROR_MAPS_SHAPE",
    "error-maps-gradient": "comparisons.paper.studies.error_maps:ERROR_MAPS_GRADIENT",
    "error-maps-jumps": "comparisons.paper.studies.error_maps:ERROR_MAPS_JUMPS",
    "error-bands": "comparisons.paper.studies.error_bands:ERROR_BANDS",
    "surface-modulus": "comparisons.paper.studies.surface_modulus:SURFACE_MODULUS",
}

#: What `--figure` takes: the numbers of the paper's figures, then what is not in the paper.
NAMES = tuple(_PLATES)


def paper_figures(names: Iterable[str] | None = None) -> list[PaperFigure]:
    """Return the figures of these names, by default all, in the order of the catalogue.

    Raises
    ------
    ValueError
        If there is no figure of a name; the sentence lists those that exist.
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
