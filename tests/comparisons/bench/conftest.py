"""A tiny part of the benchmark, whose measurements are made in this process."""

import dataclasses

import pytest
from matplotlib.figure import Figure

from comparisons.bench import run
from comparisons.bench.part import Part
from comparisons.paper.cache import make_calls

#: Sizes that were measured.
SIZES = []


def counted(size):
    SIZES.append(size)
    if size < 0:
        raise ArithmeticError("a negative size")
    return {"cpu_seconds": 0.5 * size}


def drawn(table):
    figure = Figure()
    figure.subplots().plot(table["size"], table["cpu_seconds"])
    return figure


def made_here(calls, folder, *, apart):
    assert apart
    return make_calls(calls, folder)


TINY = Part(
    "tiny",
    "a part for tests",
    lambda full: [{"size": size} for size in ((1, 2, 8) if full else (1, 2))],
    counted,
    lambda rows: rows.assign(ratio=rows["cpu_seconds"]),
    lambda rows: rows[["size"]],
    drawn,
)


@pytest.fixture
def tiny(monkeypatch):
    """The only part is the tiny one; returns a function that gives it another plan."""

    def change(**changed):
        monkeypatch.setattr(run, "PARTS", {"tiny": dataclasses.replace(TINY, **changed)})

    monkeypatch.setattr(run, "make_calls", made_here)
    SIZES.clear()
    change()
    return change
