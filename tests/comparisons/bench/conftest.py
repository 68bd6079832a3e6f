"""A tiny part of the benchmark, whose measurements are made in this process."""

import dataclasses

import pytest
from matplotlib.figure import Figure

from comparisons.bench import run
from comparisons.bench.part import Part


def counted(settings):
    if settings["size"] < 0:
        raise ArithmeticError("a negative size")
    return {"cpu_seconds": 0.5 * settings["size"]}


def drawn(table):
    figure = Figure()
    figure.subplots().plot(table["size"], table["cpu_seconds"])
    return figure


TINY = Part(
    "tiny",
    "a part for tests",
    lambda full: [{"size": size} for size in ((1, 2, 8) if full else (1, 2))],
    counted,
    lambda rows: rows.assign(ratio=rows["cpu_seconds"]),
    lambda rows: rows[["size"]],
    drawn,
    own_process=False,
)


@pytest.fixture
def tiny(monkeypatch):
    """The only part is the tiny one; returns a function that gives it another plan or another measurement."""

    def change(**changed):
        monkeypatch.setattr(run, "PARTS", {"tiny": dataclasses.replace(TINY, **changed)})

    change()
    return change
