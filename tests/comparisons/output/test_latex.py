"""Exported tables in LaTeX: ASCII alone, compiled by pdflatex where there is one."""

import sys
from pathlib import Path

import pandas as pd
import pytest

from comparisons.output.latex import escaped, latex, put_together

PAPER = Path(__file__).parents[3] / "results" / "baseline" / "paper"
#: What our texts hold, what LaTeX takes as commands, and what others may write.
TEXTS = (
    "κ = −5.24(3) %, μ ≤ 0.7, ν ≥ 0, δ ± 1 × 10⁻³, π Q^(2/n) Δγ z₀^(2/n−1), Q² ∞ √(u²) α₁₂ xᵢ",
    r"\ { } & % $ # _ ~ ^ < > | \\ \begin{x} %% $$ \input{/etc/passwd} '' `` -- --- ?` \"",
    "[1mm] after the end of a row",
    "* after the end of a row",
    "Zürich, Škoda, Łódź, naïve, Ångström, ß, æ, Œ, ø, ő, ç, ȩ, ı, ǆ, ﬁ, ½, ™, …, “a”, ‘b’, a–b—c, 5 °C",
    "中文 русский עברית 🙂 \ud800 \x00\x07\x1b \u0301 \u202e \u2028 \u200b end",
    "one\n\ntwo\r\nthree\tfour",
    "",
)


def plain(text):
    return text.isascii() and all(character.isprintable() or character == "\n" for character in text)


def test_every_character_is_one_that_latex_has():
    codes = [*range(0, sys.maxunicode + 1, 997), *range(0x3000)]
    assert [code for code in codes if not plain(escaped(chr(code)))] == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Λ µ", r"\ensuremath{\Lambda} \ensuremath{\mu}"),
        ("z₀² é e\u0301", r"z\textsubscript{0}\textsuperscript{2} \'{e} \'{e}"),
        ("[x] a_b 5 %\n b 中", r"{[}x] a\_b 5 \% b {[}U+4E2D]"),
        ("--n -2 --- a–b", r"-{}-n \ensuremath{-}2 -{}-- a\textendash{}b"),
        ("-0.5 to 2.1e-07, md-2, 2-3, -x", r"\ensuremath{-}0.5 to 2.1e-07, md-2, 2-3, -x"),
    ],
)
def test_a_text_keeps_its_meaning(text, expected):
    assert escaped(text) == expected


def test_hostile_texts_and_every_known_character_compile(typeset):
    table = pd.DataFrame({"κ (%)": TEXTS, "[μ ≤ x_1]": TEXTS[::-1]}, dtype=object)
    hostile = latex(table, "κ & μ ≤ 1 %\n\\end{tabular}", "a\\b{_1}")
    assert plain(hostile)
    known = [chr(code) for code in range(0xA0, 0x2600) if "U+" not in escaped(chr(code))]
    assert len(known) > 400
    rows = ["".join(known[start : start + 40]) for start in range(0, len(known), 40)]
    typeset(hostile, latex(pd.DataFrame({"characters": rows}), "all", "all"), fits=False)


@pytest.mark.parametrize(
    ("texts", "specification"),
    [
        (["1", "12.5", ""], "S[table-format=2.1]"),
        (["-1.788482(3)", "2"], "S[table-format=-1.6(1)]"),
        (["2.1e-07", "-3e+12", "∞"], "S[table-format=-1.1e-2]"),
        (["12(3)e2"], "S[table-format=2.0(1)e1]"),
        (["PASS", "1", "FAIL"], "l"),
        ([], "l"),
    ],
)
def test_numbers_are_aligned(texts, specification):
    text = latex(pd.DataFrame({"x": texts}, dtype=object), "c", "l")
    assert rf"{{@{{}}{specification}@{{}}}}" in text


def test_tables_fit_a_page_and_a_wide_one_is_on_its_side(typeset):
    words = "a-long-name with some words beside it"
    tables = [(PAPER / f"{name}.tex").read_text(encoding="utf-8") for name in ("paper_values", "paper_statements")]
    for count, form in ((1, "center"), (9, "landscape")):
        text = latex(pd.DataFrame({f"column {i}": [words] * 40 for i in range(count)}), words, f"form-{count}")
        assert rf"\begin{{{form}}}" in text
        assert ("pdflscape" in text) is (form == "landscape")
        assert text.count(rf"\label{{tab:form-{count}}}") == 1
        tables.append(text)
    typeset(*tables)
    together = put_together(tables[-2:])
    assert together.count("usepackage") == together.count("pdflscape") == 1
    assert together.count(r"\end{longtable}") == 2
