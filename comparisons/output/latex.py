"""Tables in LaTeX with booktabs, siunitx and longtable, in ASCII, to be input into a paper.

Any text is typeset: a character that LaTeX has no form for is written by its number, as [U+4E2D].
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import pandas as pd

from comparisons.output.table import aligned, is_number

__all__ = ["LatexTable", "escaped", "latex", "latex_table"]

_PACKAGES = r"% The document needs \usepackage{array,booktabs,longtable,pdflscape,siunitx}"

#: Rows of a table that floats; a longer one goes on on the next page.
_FLOAT_ROWS = 12


class _Page(NamedTuple):
    """Font of a table, width of its digits and of the page in points, and whether the page is turned."""

    font: str
    digit: float
    room: float
    turned: bool


_UPRIGHT = _Page("footnotesize", 4.5, 345.0, turned=False)
_TURNED = _Page("scriptsize", 4.2, 598.0, turned=True)

#: Space between two columns in points; and digits of a text that is worth a broader page.
_GAP, _TEXT = 5.0, 24.0

#: Characters with a meaning of their own.  [ and * would be taken as arguments of the end of a row.
_SPECIAL = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    "[": "{[}",
    "*": "{*}",
    '"': "{''}",
    "`": "{`}",
    **{character: "\\" + character for character in "{}&%$#_"},
}

#: Signs of mathematics by their commands.
_SIGNS = {
    "−": "-",
    "≤": r"\leq",
    "≥": r"\geq",
    "≠": r"\neq",
    "≈": r"\approx",
    "±": r"\pm",
    "×": r"\times",
    "·": r"\cdot",
    "∞": r"\infty",
    "√": r"\surd",
    "→": r"\rightarrow",
    "′": r"\prime",
    "°": r"\circ",
}

_TEXTS = {
    "–": r"\textendash{}",
    "—": r"\textemdash{}",
    "’": "{'}",
    "“": "{``}",
    "”": "{''}",
    "§": r"\S{}",
    "ß": r"\ss{}",
    "æ": r"\ae{}",
    "ø": r"\o{}",
    "Ø": r"\O{}",
    "ł": r"\l{}",
    "Ł": r"\L{}",
}

#: Combining accents by their commands.
_ACCENTS = {
    "\N{COMBINING GRAVE ACCENT}": "`",
    "\N{COMBINING ACUTE ACCENT}": "'",
    "\N{COMBINING CIRCUMFLEX ACCENT}": "^",
    "\N{COMBINING TILDE}": "~",
    "\N{COMBINING DIAERESIS}": '"',
    "\N{COMBINING RING ABOVE}": "r",
    "\N{COMBINING DOUBLE ACUTE ACCENT}": "H",
    "\N{COMBINING CARON}": "v",
    "\N{COMBINING CEDILLA}": "c",
}

#: Greek letters that have a command in both sizes, and in the small one; others have the shape of Latin letters.
_GREEK = {"GAMMA", "DELTA", "THETA", "LAMDA", "XI", "PI", "SIGMA", "UPSILON", "PHI", "PSI", "OMEGA"}
_SMALL_GREEK = _GREEK | {"ALPHA", "BETA", "EPSILON", "ZETA", "ETA", "IOTA", "KAPPA", "MU", "NU", "RHO", "TAU", "CHI"}
_LETTER = re.compile(r"GREEK (SMALL|CAPITAL) LETTER (\w+)")

#: A minus sign before a number.
_MINUS = re.compile(r"(?<![A-Za-z0-9_.)}-])-(?=[0-9])")


@dataclass(frozen=True, slots=True)
class LatexTable:
    """A table in LaTeX: what stands before and after its rows, and a line for each row."""

    before: str
    rows: list[str]
    after: str

    def text(self) -> str:
        """Return the whole table."""
        return "\n".join([self.before, *self.rows, self.after, ""])


def latex(table: pd.DataFrame, caption: str, label: str) -> str:
    r"""Return a table of texts in LaTeX that fits a page of A4.

    Columns of numbers are aligned at the decimal marker by siunitx; texts wrap where there is no room for them; a wide
    table is on its side, and a long one continues on the next page.

    Parameters
    ----------
    table : DataFrame
    caption, label : str
        A reference is to ``tab:`` and the label.

    Examples
    --------
    >>> print(latex(pd.DataFrame({"gate": ["A_1"], "E": ["1.788482(3)"]}), "Verdicts", "verdicts"), end="")
    % The document needs \usepackage{array,booktabs,longtable,pdflscape,siunitx}
    \begin{table}\footnotesize\setlength{\tabcolsep}{2.5pt}\centering
    \caption{Verdicts}\label{tab:verdicts}
    \begin{tabular}{@{}lS[table-format=1.6(1)]@{}}
    \toprule
    gate & {$E$} \\
    \midrule
    A\_1 & 1.788482(3) \\
    \bottomrule
    \end{tabular}
    \end{table}
    """
    return latex_table(table, caption, label).text()


def latex_table(table: pd.DataFrame, caption: str, label: str) -> LatexTable:
    """Return a table as `latex` does, row by row."""
    columns = [_Column(str(name), [" ".join(str(cell).split()) for cell in table[name]]) for name in table]
    page = _UPRIGHT if sum(min(one.natural, _TEXT) for one in columns) <= _digits(_UPRIGHT, columns) else _TURNED
    widths = _widths(columns, _digits(page, columns))
    wraps = [width < one.natural and not one.number for one, width in zip(columns, widths, strict=True)]
    form = "".join(
        rf">{{\raggedright\arraybackslash}}p{{{width * page.digit:.1f}pt}}" if wrapped else one.form
        for one, width, wrapped in zip(columns, widths, wraps, strict=True)
    )
    heads = [one.head(wrapped) for one, wrapped in zip(columns, wraps, strict=True)]
    head = "\n".join([r"\toprule", " & ".join(heads) + r" \\", r"\midrule"])
    cells = zip(*(one.cells(wrapped) for one, wrapped in zip(columns, wraps, strict=True)), strict=True)
    rows = [" & ".join(row) + r" \\" for row in cells] or [rf"\multicolumn{{{len(columns)}}}{{l}}{{none}} \\"]
    named = rf"\caption{{{escaped(caption)}}}\label{{tab:{re.sub('[^A-Za-z0-9-]+', '-', label)}}}"
    font = rf"\{page.font}\setlength{{\tabcolsep}}{{{_GAP / 2:g}pt}}"
    if len(rows) <= _FLOAT_ROWS and not page.turned:
        before = [rf"\begin{{table}}{font}\centering", named, rf"\begin{{tabular}}{{@{{}}{form}@{{}}}}", head]
        after = [r"\bottomrule", r"\end{tabular}", r"\end{table}"]
    else:
        around = "landscape" if page.turned else "center"
        before = [rf"\begin{{{around}}}{font}\setlength{{\LTcapwidth}}{{\linewidth}}"]
        before += [rf"\begin{{longtable}}{{@{{}}{form}@{{}}}}", rf"{named}\\", head, r"\endfirsthead"]
        before += [head, r"\endhead", r"\bottomrule", r"\endfoot"]
        after = [r"\end{longtable}", rf"\end{{{around}}}"]
    return LatexTable("\n".join([_PACKAGES, *before]), rows, "\n".join(after))


@dataclass(frozen=True)
class _Column:
    """A column of texts; its widths are in digits."""

    heading: str
    texts: Sequence[str]

    @property
    def number(self) -> bool:
        """Whether siunitx aligns it."""
        return aligned(self.texts)

    @property
    def natural(self) -> float:
        """The width if nothing wraps; the words of the heading of numbers are below each other."""
        if not self.number:
            return max(map(_width, [self.heading, *self.texts]))
        others = [text for text in self.texts if not is_number(text)]
        return max(self._format()[1], *map(_width, [*others, *self.heading.split()]))

    @property
    def least(self) -> float:
        """The width of the widest piece that cannot be broken."""
        pieces = [piece for text in (*self.texts, self.heading) for piece in re.findall(r"[^\s\-_/]+[-_/]*", text)]
        return self.natural if self.number else max(map(_width, pieces), default=0.0)

    @property
    def form(self) -> str:
        """The column in the preamble where it does not wrap."""
        return f"S[table-format={self._format()[0]}]" if self.number else "l"

    def _format(self) -> tuple[str, float]:
        """The format of siunitx that has room for every number, and its width."""
        found = [match for match in map(is_number, self.texts) if match]
        digits, decimals, bracket = (max((len(match[i] or "") for match in found), default=0) for i in (1, 2, 3))
        sign = "-" if any(match[0].startswith("-") for match in found) else ""
        powers = [str(int(match[4])) for match in found if match[4]]
        form = f"{sign}{digits}.{decimals}" + (f"({bracket})" if bracket else "")
        width = digits + decimals + 1.2 * bracket + 2.0 * bool(sign) + 2.5 * bool(bracket)
        if powers:
            minus = "-" if any(power.startswith("-") for power in powers) else ""
            most = max(len(power.lstrip("-")) for power in powers)
            return f"{form}e{minus}{most}", width + 8.0 + most
        return form, width

    def head(self, wrapped: bool) -> str:
        """The heading; a symbol of one letter is mathematics."""
        if re.fullmatch("[A-Za-z]", self.heading):
            return f"{{${self.heading}$}}"
        words = self.heading.split()
        if self.number and len(words) > 1:
            stacked = r" \\ ".join(map(escaped, words))
            return rf"{{\shortstack{{{stacked}}}}}"
        return f"{{{escaped(self.heading)}}}" if self.number else _breakable(self.heading, wrapped)

    def cells(self, wrapped: bool) -> list[str]:
        """The texts; the power of ten of a number has no plus sign and no leading zeros."""
        if not self.number:
            return [_breakable(text, wrapped) for text in self.texts]
        return [
            re.sub(r"e(-?)\+?0*([0-9])", r"e\1\2", text) if not text or is_number(text) else f"{{{escaped(text)}}}"
            for text in self.texts
        ]


def _digits(page: _Page, columns: Sequence[_Column]) -> float:
    """The room that columns have on a page, in digits."""
    return (page.room - _GAP * (len(columns) - 1)) / page.digit


def _width(text: str) -> float:
    """The width of a text in digits: capitals and signs of mathematics are broader."""
    return len(text) + 0.6 * sum(one.isupper() or one in "mwMW%&@" or not one.isascii() for one in text)


def _widths(columns: Sequence[_Column], room: float) -> list[float]:
    """The widths of columns: each has room for its longest piece, and a share of what is left."""
    wanted = [one.natural - one.least for one in columns]
    spare = max(room - sum(one.least for one in columns), 0.0)
    share = min(1.0, spare / max(sum(wanted), 1e-9))
    return [one.least + share * more for one, more in zip(columns, wanted, strict=True)]


def _breakable(text: str, wrapped: bool) -> str:
    """A text that may be broken after an underscore and after a slash, too."""
    found = escaped(text)
    return found.replace("\\_", "\\_\\allowbreak{}").replace("/", "/\\allowbreak{}") if wrapped else found


def escaped(text: str) -> str:
    r"""Return a text as LaTeX that gives it back, in ASCII and on one line.

    Examples
    --------
    >>> print(escaped("κ ≤ -5 %, Q² z₀"))
    \ensuremath{\kappa} \ensuremath{\leq} \ensuremath{-}5 \%, Q\textsuperscript{2} z\textsubscript{0}
    """
    plain = "".join(map(_character, unicodedata.normalize("NFC", " ".join(text.split()))))
    # Two hyphens would become a dash, and the option of a command could not be copied.
    return _MINUS.sub(r"\\ensuremath{-}", plain.replace("--", "-{}-"))


def _character(one: str) -> str:
    if one in _SPECIAL or one in _TEXTS:
        return (_SPECIAL | _TEXTS)[one]
    if one.isascii():
        return one if one.isprintable() else " "
    if one in _SIGNS:
        return rf"\ensuremath{{{_SIGNS[one]}}}"
    return _greek(one) or _composed(one) or f"{{[}}U+{ord(one):04X}]"


def _greek(one: str) -> str:
    """A Greek letter without an accent; empty for any other character."""
    named = _LETTER.fullmatch(unicodedata.name(one, ""))
    if not named:
        return ""
    small, name = named[1] == "SMALL", named[2]
    if name not in (_SMALL_GREEK if small else _GREEK):
        return ""
    name = name.replace("LAMDA", "LAMBDA")
    return rf"\ensuremath{{\{name.lower() if small else name.capitalize()}}}"


def _composed(one: str) -> str:
    """A letter with an accent, a superscript, a subscript or another form of known characters; else empty."""
    kind, *codes = (unicodedata.decomposition(one) or "-").split()
    parts = [chr(int(code, 16)) for code in ([] if kind == "-" else codes if kind.startswith("<") else [kind, *codes])]
    if len(parts) == 2 and parts[1] in _ACCENTS:
        return rf"\{_ACCENTS[parts[1]]}{{{_character(parts[0])}}}"
    inner = "".join(map(_character, parts))
    return {"<super>": rf"\textsuperscript{{{inner}}}", "<sub>": rf"\textsubscript{{{inner}}}"}.get(kind, inner)
