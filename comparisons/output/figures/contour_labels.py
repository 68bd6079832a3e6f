"""Labels of the contour lines of a map, where there is room for them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from numpy.typing import NDArray

__all__ = ["label_lines"]

Array = NDArray[np.float64]

#: Distance that labels keep from each other and from the frame, in pixels of the figure.
_LABEL_ROOM = 28.0


def label_lines(axes: Axes) -> None:
    """Label the lines of a map in per cent where there is room, those nearest to zero first.

    After the layout: what is room depends on the size of the axes.
    """
    drawn = [part for part in axes.collections if isinstance(part, QuadContourSet) and not part.filled]
    if not drawn:
        return
    lines = drawn[0]
    frame = axes.get_window_extent()
    taken: list[Array] = []
    ranked = sorted(zip(lines.levels, lines.allsegs, strict=True), key=lambda pair: abs(pair[0]))
    for _, segments in ranked:
        dense = [_dense(axes.transData.transform(segment)) for segment in segments if len(segment) > 1]
        if not dense:
            continue
        points = np.concatenate(dense)
        inside = [points[:, 0] - frame.x0, frame.x1 - points[:, 0], points[:, 1] - frame.y0, frame.y1 - points[:, 1]]
        room = np.minimum(np.min(inside, axis=0), 2.0 * _LABEL_ROOM)
        for place in taken:
            room = np.minimum(room, np.hypot(*(points - place).T))
        best = int(np.argmax(room))
        if room[best] >= _LABEL_ROOM:
            taken.append(points[best])
    if not taken:
        return
    places = [(float(x), float(y)) for x, y in axes.transData.inverted().transform(taken)]
    for label in lines.axes.clabel(
        lines, fmt=lambda level: f"{level:+g} %".replace("-", "\N{MINUS SIGN}"), fontsize=7, manual=places
    ):
        label.set_bbox({"boxstyle": "round,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.85})


def _dense(points: Array) -> Array:
    """Points of a line, in pixels, with others between them."""
    share = np.linspace(0.0, 1.0, 8)[:, None, None]
    return ((1.0 - share) * points[:-1] + share * points[1:]).reshape(-1, 2)
