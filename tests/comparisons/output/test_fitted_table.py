"""Tables that fit the columns of a terminal."""

import io

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from comparisons.output.fitted_table import FittedTable

NAMES = ["carpick-ogletree-salmeron", "double-hertz-n-k", "jkr"]
TABLE = pd.DataFrame(
    {
        "quantity": ["zero_load_displacement", "pull_off_force", "pull_off_force"],
        "model": NAMES,
        "domain": ["n = 2 and k = 0, fitted to the values of another model", "every n and k", "soft solids"],
        "kappa": ["-89.682(5)", "1132.945(5)", "2.10(4)e-7"],
        "seconds": ["1", "2", "3"],
    },
    dtype=object,
)


def words(text):
    return sorted(text.split())


@pytest.mark.parametrize("width", range(30, 140, 5))
@pytest.mark.parametrize("optional", [(), ("seconds",)])
def test_every_word_is_whole_at_every_width(width, optional):
    table = FittedTable(TABLE, right=frozenset(("kappa", "seconds")), group="quantity", optional=optional)
    shown = table.lines(width)
    assert max(map(len, shown)) <= width
    text = "\n".join(shown)
    omitted = "without seconds" in text
    for name in TABLE:
        for cell in TABLE[name]:
            if not (omitted and name == "seconds"):
                assert all(word in text.split() for word in cell.split())


def test_a_wide_terminal_has_one_line_a_row():
    assert len(FittedTable(TABLE).lines(200)) == 2 + len(TABLE)


def test_a_group_becomes_headings_before_anything_is_omitted():
    shown = FittedTable(TABLE, group="quantity", optional=("seconds",)).lines(75)
    assert [line for line in shown if line.startswith("quantity: ")] == [
        "quantity: zero_load_displacement",
        "quantity: pull_off_force",
    ]
    assert not any("without" in line for line in shown)


def test_columns_that_are_omitted_are_named():
    table = FittedTable(TABLE.drop(columns=["domain", "quantity"]), optional=("seconds", "kappa"))
    assert table.lines(42)[-2:] == ["without seconds, for which 42 columns are", "too few"]
    assert not table.is_table(42)


def test_a_row_that_does_not_fit_is_a_block():
    shown = FittedTable(TABLE).lines(40)
    assert shown[:2] == ["zero_load_displacement", "  model    carpick-ogletree-salmeron"]
    assert shown[2] == "  domain   n = 2 and k = 0, fitted to"


def test_a_word_that_is_longer_than_the_line_is_printed_whole():
    path = "/a/" + "long" * 20
    console = Console(file=io.StringIO(), width=40)
    console.print(FittedTable(pd.DataFrame({"model": ["jkr"], "file": [path]})), crop=False)
    assert path in console.file.getvalue()


def test_external_text_is_not_markup():
    console = Console(file=io.StringIO(), width=40)
    console.print(FittedTable(pd.DataFrame({"reason": ["[bold]k in [0, 1]"]}), "[b]title"))
    assert "[bold]k in [0, 1]" in console.file.getvalue()
    assert "[b]title" in console.file.getvalue()


@given(st.lists(st.text(st.characters(codec="ascii", categories=("L", "N")), max_size=12), min_size=1, max_size=5))
def test_any_cells_are_kept(cells):
    table = FittedTable(pd.DataFrame({f"column{number}": [cell] for number, cell in enumerate(cells)}, dtype=object))
    for width in (10, 20, 80):
        shown = words(" ".join(table.lines(width)))
        assert all(cell in shown for cell in cells if cell)
