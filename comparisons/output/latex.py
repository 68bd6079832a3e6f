"""Texts and tables in LaTeX with booktabs, siunitx and longtable, in ASCII, to be input into a paper.

Any text is typeset: a character that LaTeX has no form for is written by its number, as [U+4E2D].
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, NamedTuple

import lazy_loader

from comparisons.numerics.number_text import aligned, number_parts

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")

#: Shorter texts do not wrap; the space between two columns, in characters.
_SHORT, _GAP = 16, 1.2


def _pairs(words: str) -> dict[str, str]:
    """Every other word by the one before it."""
    listed = words.split()
    return dict(zip(listed[::2], listed[1::2], strict=True))


#: Characters with a meaning of their own.  [ and * would be taken as arguments of the end of a row.
_SPECIAL = {character: "\\" + character for character in "{}&%$#_"}
_SPECIAL |= _pairs("[ {[} * {*} \" {''} ` {`} ’ {'} “ {``} ” {''}")

#: Commands of text, signs of mathematics, and Greek letters that have a command.
_TEXTS = _pairs(r"\ textbackslash ~ textasciitilde ^ textasciicircum < textless > textgreater | textbar")
_TEXTS |= _pairs("– textendash — textemdash § S æ ae ø o Ø O ł l Ł L ß ss")
_SIGNS = _pairs("≤ leq ≥ geq ≠ neq ≈ approx ± pm × times · cdot ∞ infty √ surd → rightarrow ′ prime ° circ")
_GREEK = "αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΥΦΨΩ"

#: Combining accents: grave, acute, circumflex, tilde, diaeresis, ring, double acute, caron, cedilla.
_ACCENTS = _pairs("\u0300 ` \u0301 ' \u0302 ^ \u0303 ~ \u0308 \" \u030a r \u030b H \u030c v \u0327 c")

#: A minus sign before a number.
_MINUS = re.compile(r"(?<![A-Za-z0-9_.)}-])-(?=[0-9])")


class _Page(NamedTuple):
    """Font of a table, characters of a line, the environment around the table, and the packages that it needs."""

    font: str
    characters: int
    around: str
    packages: str


_UPRIGHT = _Page("footnotesize", 74, "center", "array,booktabs,longtable,siunitx")
_TURNED = _Page("scriptsize", 138, "landscape", "array,booktabs,longtable,pdflscape,siunitx")

#: Characters of a line of a table that is not turned.
UPRIGHT_WIDTH = _UPRIGHT.characters


def latex(texts: pd.DataFrame, caption: str, label: str) -> str:
    r"""Return a table of texts in LaTeX.

    Columns of numbers are aligned at the decimal marker by siunitx, long texts wrap, a wide table is on its side, and a
    long one continues on the next page.

    Parameters
    ----------
    texts : DataFrame
    caption, label : str
        A reference is to ``tab:`` and the label.

    Examples
    --------
    >>> print(latex(pd.DataFrame({"gate": ["A_1"], "E": ["1.788482(3)"]}), "Verdicts", "verdicts").split("endhead")[0])
    % The document needs \usepackage{array,booktabs,longtable,siunitx}
    \begin{center}\footnotesize\setlength{\tabcolsep}{2.5pt}\setlength{\LTcapwidth}{\linewidth}
    \begin{longtable}{@{}lS[table-format=1.6(1)]@{}}
    \caption{Verdicts} \label{tab:verdicts} \\
    \toprule
    {gate} & {$E$} \\
    \midrule
    \endfirsthead
    \caption[]{Verdicts} \\
    \toprule
    {gate} & {$E$} \\
    \midrule
    \
    """
    before, rows, after = latex_parts(texts, caption, label)
    return "\n".join([before, *rows, after, ""])


def put_together(tables: Iterable[str]) -> str:
    """Return tables of `latex` one after the other, below one line with the packages that they need."""
    needed, bodies = zip(*(table.split("\n", 1) for table in tables), strict=True)
    # A table on its side needs one package more.
    return "\n".join([max(needed, key=len), *bodies])


def latex_parts(texts: pd.DataFrame, caption: str, label: str) -> tuple[str, list[str], str]:
    """Return a table as `latex` does: what stands before its rows, a line for each row, and what stands after them."""
    plain = {str(name): [" ".join(str(text).split()) for text in texts[name]] for name in texts}
    page, form = _layout(plain)
    cells = pd.DataFrame({_heading(name, column): _cells(column) for name, column in plain.items()}, dtype=object)
    table = cells.style.hide(axis="index").to_latex(
        environment="longtable",
        hrules=True,
        siunitx=True,
        caption=escaped(caption),
        label="tab:" + re.sub("[^A-Za-z0-9-]+", "-", label),
        column_format=form,
    )
    margins = r"\setlength{\tabcolsep}{2.5pt}\setlength{\LTcapwidth}{\linewidth}"
    head, end_of_head, body = table.partition("\\endlastfoot\n")
    rows, end, _ = body.partition(r"\end{longtable}")
    needed = rf"% The document needs \usepackage{{{page.packages}}}"
    before = f"{needed}\n\\begin{{{page.around}}}\\{page.font}{margins}\n{head}{end_of_head}"
    return before.rstrip("\n"), rows.splitlines(), f"{end}\n\\end{{{page.around}}}"


def _layout(texts: Mapping[str, list[str]]) -> tuple[_Page, str]:
    """The page of a table, and the form of its columns; texts that are not short share the room that others leave."""
    widths = {name: max(map(len, [*name.split(), *column])) + _GAP for name, column in texts.items()}
    wraps = [name for name, width in widths.items() if width > _SHORT and not aligned(texts[name])]
    page = _UPRIGHT if sum(min(width, 2 * _SHORT) for width in widths.values()) <= _UPRIGHT.characters else _TURNED
    free = page.characters - sum(width for name, width in widths.items() if name not in wraps)
    forms = {name: f"S[table-format={_number_format(texts[name])}]" if aligned(texts[name]) else "l" for name in widths}
    # The shortest first: what it leaves is for the others.  A number does not wrap.
    for index, name in enumerate(sorted(wraps, key=widths.__getitem__)):
        numbers = [len(word) + _GAP for text in texts[name] for word in text.split() if number_parts(word)]
        share = min(widths[name], max(free / (len(wraps) - index), 6.0, *numbers))
        free -= share
        if share < widths[name]:
            forms[name] = rf">{{\raggedright\arraybackslash}}p{{{(share - _GAP) / page.characters:.3f}\linewidth}}"
    return page, f"@{{}}{''.join(forms.values())}@{{}}"


def _number_format(texts: list[str]) -> str:
    """The format of siunitx that has room for every number."""
    parts = [match for match in map(number_parts, texts) if match]
    digits, decimals, bracket = (max((len(match[i] or "") for match in parts), default=0) for i in (1, 2, 3))
    powers = [str(int(match[4])) for match in parts if match[4]]
    minus = "-" if any(power.startswith("-") for power in powers) else ""
    power = f"e{minus}{max(len(power.lstrip('-')) for power in powers)}" if powers else ""
    sign = "-" if any(match[0].startswith("-") for match in parts) else ""
    return f"{sign}{digits}.{decimals}" + (f"({bracket})" if bracket else "") + power


def _heading(heading: str, texts: list[str]) -> str:
    """A heading; a symbol of one letter is mathematics, and the words above numbers are below each other."""
    if re.fullmatch("[A-Za-z]", heading):
        return f"${heading}$"
    stacked = r" \\ ".join(map(escaped, heading.split()))
    return rf"\shortstack{{{stacked}}}" if aligned(texts) and " " in heading else escaped(heading)


def _cells(texts: list[str]) -> list[str]:
    """The cells; the power of ten of a number has no plus sign and no leading zeros."""
    if not aligned(texts):
        return [escaped(text).replace("\\_", "\\_\\allowbreak{}").replace("/", "/\\allowbreak{}") for text in texts]
    return [
        re.sub(r"e(-?)\+?0*([0-9])", r"e\1\2", text) if not text or number_parts(text) else f"{{{escaped(text)}}}"
        for text in texts
    ]


def escaped(text: str) -> str:
    r"""Return a text as LaTeX that gives it back, in ASCII and on one line.

    Examples
    --------
    >>> print(escaped("κ ≤ -5 %, Q² z₀"))
    \ensuremath{\kappa} \ensuremath{\leq} \ensuremath{-}5 \%, Q\textsuperscript{2} z\textsubscript{0}
    """
    plain = "".join(map(_character, unicodedata.normalize("NFC", " ".join(text.split()))))
    # Two hyphens would become a dash, and the option of a command could not be copied.
    return _MINUS.sub(r"\\ensuremath{-}", plain.replace("−", r"\ensuremath{-}").replace("--", "-{}-"))


def _character(character: str) -> str:
    if character in _SPECIAL:
        return _SPECIAL[character]
    if character in _TEXTS:
        return rf"\{_TEXTS[character]}{{}}"
    if character.isascii() or character == "−":
        return character if character.isprintable() else " "
    if character in _SIGNS:
        return rf"\ensuremath{{\{_SIGNS[character]}}}"
    if character in _GREEK:
        name = unicodedata.name(character).split()[-1].replace("LAMDA", "LAMBDA")
        return rf"\ensuremath{{\{name.lower() if character.islower() else name.capitalize()}}}"
    return _composed(character) or f"{{[}}U+{ord(character):04X}]"


def _composed(character: str) -> str:
    """A letter with an accent, a superscript, a subscript or another form of known characters; else empty."""
    kind, *codes = (unicodedata.decomposition(character) or "-").split()
    parts = [chr(int(code, 16)) for code in ([] if kind == "-" else codes if kind.startswith("<") else [kind, *codes])]
    if len(parts) == 2 and parts[1] in _ACCENTS:
        return rf"\{_ACCENTS[parts[1]]}{{{_character(parts[0])}}}"
    inner = "".join(map(_character, parts))
    return {"<super>": rf"\textsuperscript{{{inner}}}", "<sub>": rf"\textsubscript{{{inner}}}"}.get(kind, inner)
