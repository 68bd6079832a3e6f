"""Pictures drawn from the committed tables: nothing extends beyond the page, and panels are lettered in order."""

from pathlib import Path
from string import ascii_lowercase

import pandas as pd
import pytest

from comparisons.paper.registry import paper_figures

BASELINE = Path(__file__).parents[3] / "results" / "baseline" / "paper"
DRAWN = {figure.name: figure for figure in paper_figures() if figure.draw}
#: Every so many pictures are drawn in every test run.
LIGHT = 4
PICTURES = [pytest.param(name, marks=() if at % LIGHT == 0 else pytest.mark.heavy) for at, name in enumerate(DRAWN)]
#: Of the page, in inches: rounding to pixels.
EDGE = 0.01


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_whole(name):
    figure = DRAWN[name]
    files = sorted(BASELINE.glob(f"{figure.stem}*.csv"))
    figure = figure.draw({path.stem[len(figure.stem) :].removeprefix("_"): pd.read_csv(path) for path in files})
    figure.draw_without_rendering()
    shown = figure.get_tightbbox()
    width, height = figure.get_size_inches()
    assert min(shown.x0, shown.y0) > -EDGE
    assert shown.x1 < width + EDGE
    assert shown.y1 < height + EDGE
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    # Twice where a panel is shown again, enlarged.
    letters = "".join(dict.fromkeys(title[1] for title in titles if title))
    assert letters == ascii_lowercase[: len(letters)]
