"""Layout of a table in LaTeX: columns of numbers, texts that wrap, and the size at which the table fits a page."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from comparisons.output.latex_text import TOKENS, breakable, headed

__all__ = ["NUMBER", "Column", "Size", "fitted"]

#: What siunitx reads as a number; the scripts of the report use the same pattern.
NUMBER = r"-?([0-9]+)(?:\.([0-9]+))?(?:\(([0-9]+)\))?(?:e([+-]?[0-9]+))?"
_NUMBER, _TOKEN = re.compile(NUMBER), re.compile(TOKENS)

#: Widths of Computer Modern in em, at 10 pt; capitals and signs not named here have 0.78 at most, small letters 0.56.
_WIDTHS = {
    character: width for width, characters in ((0.28, "ijl.,:;'|!"), (0.4, "frst()[]-I /")) for character in characters
}
_WIDTHS |= dict.fromkeys("mw%&@", 0.84) | dict.fromkeys("MWÆŒ", 1.03) | dict.fromkeys("0123456789", 0.5)
_CAPITAL, _SMALL = 0.78, 0.56
#: Estimates are made larger by this factor: they leave out kerning, and smaller types are not scaled evenly.
_SAFETY = 1.04

#: Width of the text of an article on A4, upright and on its side, in points.
_UPRIGHT, _SIDEWAYS = 345.0, 598.0

#: Lines of the tallest row with which an arrangement is taken; the next is tried if no arrangement has it.
_LINES = (4, 7, 12, 60)

#: Texts whose width is kept: the cells of a column are measured more than once, and many are the same.
_MEASURED = 2**16


@dataclass(frozen=True, slots=True)
class Size:
    """Font of a table, its width for 10 pt type, the space beside a column, and whether the page is turned."""

    name: str
    scale: float
    gap: float
    sideways: bool

    @property
    def room(self) -> float:
        """Width of the text in points."""
        return _SIDEWAYS if self.sideways else _UPRIGHT


#: In the order in which they are tried; small types are wider than their size (cmr8 has digits of 0.53 em).
_SIZES = (
    Size("small", 9.3, 4.0, sideways=False),
    Size("footnotesize", 8.5, 3.0, sideways=False),
    Size("scriptsize", 8.0, 2.5, sideways=False),
    Size("footnotesize", 8.5, 3.0, sideways=True),
    Size("scriptsize", 8.0, 2.0, sideways=True),
    Size("tiny", 6.9, 2.0, sideways=True),
)


@dataclass(frozen=True, slots=True)
class Column:
    r"""A column of texts.

    Attributes
    ----------
    heading : str
    texts : sequence of str
    number : bool
        Whether it is aligned by siunitx: at least half of its texts are numbers.
    width : float
        Of the column where it wraps, in points; zero where it does not.

    Examples
    --------
    >>> Column("value", ["-1.788(3)", "2.1e-07"]).specification
    'S[table-format=-1.3(1)e-1]'
    """

    heading: str
    texts: Sequence[str] = field(repr=False)
    width: float = 0.0

    @property
    def number(self) -> bool:
        """Whether siunitx aligns it: at least half of its texts are numbers."""
        filled = [text for text in self.texts if text]
        return 2 * sum(_NUMBER.fullmatch(text) is not None for text in filled) >= max(len(filled), 1)

    @property
    def specification(self) -> str:
        """The column in the preamble of the table."""
        if self.number:
            return f"S[table-format={self._format()[0]}]"
        return rf">{{\raggedright\arraybackslash}}p{{{self.width:.1f}pt}}" if self.width else "l"

    @property
    def head(self) -> str:
        """The heading, in lines that are no wider than the column needs to be."""
        lines = [headed(line) for line in self._head_lines()]
        if len(lines) == 1:
            return f"{{{lines[0]}}}" if self.number else breakable(lines[0]) if self.width else lines[0]
        stacked = r" \\ ".join(lines)
        return rf"{{\shortstack{{{stacked}}}}}" if self.number else rf"\shortstack[l]{{{stacked}}}"

    def natural(self) -> float:
        """Width in em of the widest text and of the heading, if nothing wraps."""
        return max(self._content(), *map(_em, self._head_lines()))

    def least(self) -> float:
        """Width in em of the widest piece that cannot be broken."""
        return max(_em(piece) for text in (*self.texts, self.heading) for piece in _pieces(text))

    def lines(self, width: float) -> int:
        """Return how many lines the tallest row has in a column of a width in em; ragged lines fill four fifths."""
        return max((int(_em(text) / (0.8 * width)) + 1 for text in self.texts), default=1) if width else 1

    def _head_lines(self) -> list[str]:
        words = self.heading.split() or [""]
        limit = max(self._content(), *map(_em, words))
        lines = [words[0]]
        for word in words[1:]:
            if _em(f"{lines[-1]} {word}") <= limit:
                lines[-1] += f" {word}"
            else:
                lines.append(word)
        return lines

    def _content(self) -> float:
        if not self.number:
            return max(map(_em, self.texts), default=0.0)
        others = [_em(text) for text in self.texts if not _NUMBER.fullmatch(text)]
        return max(self._format()[1], *others, 0.0)

    def _format(self) -> tuple[str, float]:
        """The format of siunitx that has room for every number, and its width in em."""
        found = [match for match in map(_NUMBER.fullmatch, self.texts) if match]
        sign = "-" if any(match[0].startswith("-") for match in found) else ""
        digits, decimals, bracket = (max((len(match[i] or "") for match in found), default=0) for i in (1, 2, 3))
        powers = [str(int(match[4])) for match in found if match[4]]
        form = f"{sign}{max(digits, 1)}.{decimals}" + (f"({bracket})" if bracket else "")
        width = 0.9 * bool(sign) + 0.5 * (digits + decimals + bracket) + 0.3 * bool(decimals) + 0.9 * bool(bracket)
        # siunitx parts five digits and more into groups of three.
        width += sum(0.2 * ((size - 1) // 3) for size in (digits, decimals) if size > 4)
        if powers:
            minus = "-" if any(power.startswith("-") for power in powers) else ""
            size = max(len(power.lstrip("-")) for power in powers)
            form += f"e{minus}{size}"
            width += 3.2 + 0.7 * bool(minus) + 0.42 * size
        return form, width


@lru_cache(maxsize=_MEASURED)
def _em(text: str) -> float:
    """Return the width of a text; a minus sign and a power of ten are wider than their characters."""
    width = sum(map(_width, text))
    numbers = [match[0] for match in _TOKEN.finditer(text)]
    return _SAFETY * (
        width + sum(0.4 * number.startswith("-") + 1.8 * ("e" in number) + _spaces(number) for number in numbers)
    )


def _spaces(number: str) -> float:
    """Return the width of the spaces of siunitx between groups of three of more than four digits."""
    groups = [len(digits) for digits in re.findall(r"\d+", number.partition("(")[0].partition("e")[0])]
    return sum(0.2 * ((size - 1) // 3) for size in groups if size > 4)


@lru_cache(maxsize=_MEASURED)
def _width(one: str) -> float:
    """Return the width of a character."""
    return _WIDTHS.get(one, _CAPITAL if one.isupper() or not one.isascii() or not one.isalpha() else _SMALL)


def _pieces(text: str) -> Iterator[str]:
    """Yield what LaTeX does not break: it breaks at spaces, after hyphens and after what `breakable` names."""
    numbers = [match[0] for match in _TOKEN.finditer(text)]
    yield from re.findall(r"[^\s\-_/]+[\-_/]*|[\-_/]+", text) or [""]
    yield from numbers


def fitted(columns: Sequence[Column]) -> tuple[Size, list[Column], int]:
    """Return the largest type with which a table fits a page, the columns with their widths, and its tallest row.

    Examples
    --------
    >>> size, columns, lines = fitted([Column("model", ["jkr"]), Column("reason", ["it is not applicable " * 9])])
    >>> size.name, size.sideways, columns[0].width, lines
    ('small', False, 0.0, 4)
    """
    natural = [one.natural() for one in columns]
    least = [0.0 if one.number else one.least() for one in columns]
    for most in _LINES:
        for size in _SIZES:
            widths = _widths(columns, natural, least, size, most)
            if widths is not None:
                break
        else:
            continue
        break
    else:
        # Not even the smallest type has room: what cannot be broken is wider than a page.
        widths = least
    placed = [
        Column(one.heading, one.texts, 0.0 if one.number or width >= whole else width * size.scale)
        for one, width, whole in zip(columns, widths, natural, strict=True)
    ]
    lines = max((one.lines(one.width / size.scale) for one in placed), default=1)
    return size, placed, lines


def _widths(
    columns: Sequence[Column], natural: Sequence[float], least: Sequence[float], size: Size, most: int
) -> list[float] | None:
    """Return widths in em with which no row has more lines; None if there is no room for them."""
    room = size.room / size.scale - 2 * size.gap * (len(columns) - 1) / size.scale
    narrowest = [
        width if one.number else min(width, max(unbroken, width / (0.8 * most)))
        for one, width, unbroken in zip(columns, natural, least, strict=True)
    ]
    spare = room - sum(narrowest)
    if spare < 0.0:
        return None
    wanted = [wide - narrow for wide, narrow in zip(natural, narrowest, strict=True)]
    share = min(1.0, spare / max(sum(wanted), 1e-9))
    return [narrow + share * more for narrow, more in zip(narrowest, wanted, strict=True)]
