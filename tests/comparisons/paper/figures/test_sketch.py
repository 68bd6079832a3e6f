"""Fig. 1: a sketch without data."""

import numpy as np

from comparisons.paper.cache import Results
from comparisons.paper.figures.fig01_sketch import SKETCH, _punch, _surface
from comparisons.paper.paper_figure import write


def test_it_is_a_picture_only(tmp_path):
    assert SKETCH.tasks() == ()
    written = write(SKETCH, SKETCH.tables(Results()), tmp_path)
    assert sorted(path.name for path in written) == ["fig01_sketch.pdf", "fig01_sketch.png"]
    assert all(path.stat().st_size > 1000 for path in written)


def test_the_punch_is_above_the_surface():
    r = np.linspace(-4.2, 4.2, 841)
    gap = _punch(r) - _surface(r)
    assert gap.min() > 0.01
    # The surface is pressed down on the axis and piles up beside the contact (Fig. 5).
    assert _surface(r)[420] < 0 < _surface(r).max()
