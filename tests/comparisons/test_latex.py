"""Exported tables in LaTeX: ASCII alone, compiled by pdflatex where there is one."""

import sys
import unicodedata
from pathlib import Path

import pandas as pd
import pytest

from comparisons.output.latex import latex
from comparisons.output.latex_layout import Column
from comparisons.output.latex_text import comment, escaped

PAPER = Path(__file__).parents[2] / "results" / "baseline" / "paper"
#: What our texts hold, what LaTeX takes as commands, and what others may write.
TEXTS = (
    "κ = −5.24(3) %, μ ≤ 0.7, ν ≥ 0, δ ± 1 × 10⁻³, π Q^(2/n) Δγ z₀^(2/n−1), Q² ∞ √(u²) α₁₂ xᵢ",
    "αβγδεζηθικλμνξοπρςστυφχψω ΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨΩ ϵϑϕϱϰϖ ά ΐ µ",
    r"\ { } & % $ # _ ~ ^ < > | \\ \begin{x} %% $$ \input{/etc/passwd} '' `` -- --- ?` \"",
    "[1mm] after the end of a row",
    "* after the end of a row",
    "Zürich, Škoda, Łódź, naïve, Ångström, ß, æ, Œ, ø, ő, ç, ȩ, ı, ǆ, ﬁ, ½, ™, …, “a”, ‘b’, a–b—c, 5 °C",
    "中文 русский עברית 🙂 \ud800 \x00\x07\x1b \u0301 \u202e \u2028 \u200b end",
    "one\n\ntwo\r\nthree\tfour",
    "≠ ≈ ≡ ∼ ∝ ≪ ≫ ∓ ÷ · ⋅ ∂ ∇ ∫ ∑ ∏ ∈ → ← ↑ ↓ ↔ ⇒ ′ § ⁄ ‰ ½",
    "",
)


def test_a_long_word_of_a_heading_is_broken_in_a_narrow_column():
    assert Column("law.work_of_adhesion", ["20 mJ/m^2"], width=40.0).head == (
        r"law.work\_\allowbreak{}of\_\allowbreak{}adhesion"
    )
    assert Column("law.work_of_adhesion", ["20 mJ/m^2"]).head == r"law.work\_of\_adhesion"


def plain(text):
    return text.isascii() and all(one.isprintable() or one == "\n" for one in text)


def hostile_table():
    table = pd.DataFrame({"κ (%)": TEXTS, "[μ ≤ x_1]": TEXTS[::-1]}, dtype=object)
    return latex(table, "κ & μ ≤ 1 %\n\\end{tabular}", "a\\b{_1}")


def test_every_character_of_the_table_is_one_that_latex_has():
    assert plain(hostile_table())
    every = [chr(code) for code in range(sys.maxunicode + 1) if unicodedata.category(chr(code)) != "Cn"]
    assert [one for one in every[:: 1 if len(every) < 50_000 else 7] if not plain(escaped(one))] == []
    assert [chr(code) for code in range(0x3000) if not plain(escaped(chr(code)) + comment(chr(code)))] == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("κ", r"\ensuremath{\kappa}"),
        ("Λ", r"\ensuremath{\Lambda}"),
        ("≤", r"\ensuremath{\leq}"),
        ("z₀²", r"z\textsubscript{0}\textsuperscript{2}"),
        ("é", r"\'{e}"),
        ("e\u0301", r"\'{e}"),
        ("[x]", "{[}x]"),
        ("--n 2", "-{}-n 2"),
        ("---", "-{}--"),
        ("a\n b", "a b"),
        ("中", "{[}U+4E2D]"),
        ("solve --n -2", r"solve -{}-n \num{-2}"),
        ("-0.5 to 2.1e-07(4e-09)", r"\num{-0.5} to \num{2.1e-7}(\num{4e-9})"),
        ("1.50(3), md-2, N1.5, 2-3, -x", r"\num{1.50(3)}, md-2, N1.5, 2-3, -x"),
        ("mu = 1, n, k >= 2", r"$\mu$ = 1, n, k \textgreater{}= 2"),
    ],
)
def test_a_text_keeps_its_meaning(text, expected):
    assert escaped(text) == expected


def test_hostile_texts_compile(typeset):
    typeset(hostile_table(), fits=False)


def test_every_greek_letter_sign_and_accent_compiles(typeset):
    known = [chr(code) for code in range(0xA0, 0x2600) if "U+" not in escaped(chr(code))]
    assert len(known) > 500
    rows = ["".join(known[start : start + 40]) for start in range(0, len(known), 40)]
    typeset(latex(pd.DataFrame({"characters": rows}), "all", "all"), fits=False)


def test_the_tables_of_the_paper_fit_a_page(typeset):
    texts = [(PAPER / f"{name}.tex").read_text(encoding="utf-8") for name in ("paper_values", "paper_statements")]
    assert all(map(plain, texts))
    typeset(*texts)


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


@pytest.mark.parametrize(
    ("rows", "wide", "form"), [(3, 1, "table"), (36, 1, "table"), (37, 1, "longtable"), (3, 9, "landscape")]
)
def test_a_table_floats_or_continues_or_is_on_its_side(typeset, rows, wide, form):
    words = "a-long-name with some words beside it"
    text = latex(pd.DataFrame({f"column {i}": [words] * rows for i in range(wide)}), words, "form")
    assert rf"\begin{{{form}}}" in text
    assert text.count(r"\caption{") == text.count(r"\label{tab:form}") == 1
    typeset(text)


def test_texts_wrap_where_the_page_has_no_room(typeset):
    row = ["fscm", "the pull_off_force at n = 2 is not_certain and/or it has no_value " * 4, "-0.00123(4)", "1.5e-08"]
    text = latex(pd.DataFrame([row] * 4, columns=["model", "reason", "E", "U"]), "κ", "wraps")
    assert r"p{" in text
    assert r"pull\_\allowbreak{}off" in text
    typeset(text)
