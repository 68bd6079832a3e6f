"""Exported tables in LaTeX: ASCII alone, compiled by pdflatex where there is one."""

import sys
import unicodedata
from pathlib import Path

import pandas as pd
import pytest

from comparisons.output.latex import latex
from comparisons.output.latex_text import comment, escaped

BASELINE = Path(__file__).parents[2] / "results" / "baseline" / "paper" / "paper_values.tex"
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


def plain(text):
    return text.isascii() and all(one.isprintable() or one == "\n" for one in text)


def hostile_table():
    return latex(pd.DataFrame({"κ (%)": TEXTS, "[μ ≤ x_1]": TEXTS[::-1]}, dtype=object), "κ & μ ≤ 1 %\n\\end{tabular}")


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
    ],
)
def test_a_text_keeps_its_meaning(text, expected):
    assert escaped(text) == expected


def test_hostile_texts_compile(typeset):
    typeset(hostile_table())


def test_every_greek_letter_sign_and_accent_compiles(typeset):
    known = [chr(code) for code in range(0xA0, 0x2600) if "U+" not in escaped(chr(code))]
    assert len(known) > 500
    rows = ["".join(known[start : start + 40]) for start in range(0, len(known), 40)]
    typeset(latex(pd.DataFrame({"characters": rows}), "all"))


def test_the_numbers_of_the_paper_compile(typeset):
    text = BASELINE.read_text(encoding="utf-8")
    assert plain(text)
    typeset(text)
