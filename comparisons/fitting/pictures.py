"""Pictures of fits: of a curve with its residuals, and of the values of a map."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.fitting.fit import Fit
from comparisons.numerics.number_text import short
from comparisons.output.style import COLOURS, new_figure, styled
from comparisons.problem.units import prefixed_unit, si_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw"]


def draw(fitted: Fit) -> Figure:
    """Draw a record, the fitted loads and the residuals."""
    record = fitted.record
    load = record.load - fitted.baseline
    (x_power, x_unit), (y_power, y_unit) = (
        prefixed_unit(float(np.abs(values).max()), unit) for values, unit in ((fitted.position, "m"), (load, "N"))
    )
    with styled():
        figure = new_figure(6.0, 5.0)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        for branch, mask in _of_branches(record.approach):
            x, colour = fitted.position[mask] * 10.0**-x_power, COLOURS[0 if branch == "approach" else 1]
            upper.plot(x, load[mask] * 10.0**-y_power, ".", color=colour, ms=2, alpha=0.4, label=branch)
            upper.plot(x, fitted.load[mask] * 10.0**-y_power, color=colour, label=f"{branch}, {fitted.model}")
            lower.plot(x, (load - fitted.load)[mask] * 10.0**-y_power, ".", color=colour, ms=2)
        upper.set(ylabel=f"load ({y_unit})", title=_title(fitted))
        position = "displacement" if np.isinf(record.stiffness) else "position of the cantilever"
        lower.set(xlabel=f"{position} ({x_unit})", ylabel="residual")
        upper.legend()
    return figure


def _of_branches(approach: Any) -> Iterator[tuple[str, Any]]:
    for branch, mask in (("approach", approach), ("retreat", ~approach)):
        if mask.any():
            yield branch, mask


def _title(fitted: Fit) -> str:
    values = (
        f"{key} = {si_text(row.value, row.u, row.unit)}" for key, row in fitted.parameters.items() if row.determined
    )
    return ", ".join(values) or f"{fitted.record.name}: {short(fitted.residual, 0.0)} N"
