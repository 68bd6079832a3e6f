"""Pressures or gaps over the radius of several models in one picture."""

from __future__ import annotations

from matplotlib.figure import Figure

from comparisons.curve_quantities import Points
from comparisons.output.style import COLOURS, LINES, styled

__all__ = ["draw"]

#: What is over the radius, by the name of the shape.
_LABELS = {
    "pull_off_pressure": r"pressure at pull-off $p z_0 / \Delta\gamma$, tension negative",
    "pull_off_gap": r"gap at pull-off $H / z_0$",
}


def draw(profiles: dict[str, Points], quantity: str, title: str) -> Figure:
    """Draw the surface where P is smallest.

    Parameters
    ----------
    profiles : dict of str to Points
        By model name.
    quantity : str
        A name of `comparisons.curve_quantities.SHAPES` that is over the radius.
    title : str
        Which problem it is.

    Examples
    --------
    >>> figure = draw({"a": Points([0.0, 1.0], [1.0, 1.5], 0.0)}, "pull_off_gap", "n = 2")
    >>> figure.axes[0].get_ylabel()
    'gap at pull-off $H / z_0$'
    """
    with styled():
        figure = Figure(figsize=(5.0, 3.8), layout="constrained")
        axes = figure.subplots()
        for index, (name, points) in enumerate(profiles.items()):
            colour, line = COLOURS[index % len(COLOURS)], LINES[index % len(LINES)]
            axes.plot(points.x, points.y, label=name, color=colour, ls=line)
        axes.axhline(0, color="0.4", lw=0.8)
        axes.set_xlim(left=0.0)
        axes.set_xlabel(r"radius $r / (Q z_0)^{1/n}$")
        axes.set_ylabel(_LABELS[quantity])
        axes.set_title(title)
        if profiles:
            axes.legend()
    return figure
