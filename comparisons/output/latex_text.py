"""Any text as ASCII that LaTeX typesets: special characters, Greek letters, signs, accents.

A character that has no such form is written by its number, as [U+4E2D]: the document still compiles.
"""

from __future__ import annotations

import re
import unicodedata

__all__ = ["TOKENS", "breakable", "comment", "escaped", "headed", "number_text"]

_MANTISSA, _BRACKET, _POWER = r"[0-9]+(?:\.[0-9]+)?", r"\([0-9]+\)", r"e[+-]?[0-9]+"
#: Numbers that need a minus sign, a power of ten or an uncertainty, and symbols of parameters that are given a value:
#: both are typeset as mathematics.  The scripts of the report use the same pattern, so that it has only what Python
#: and JavaScript read in the same way.
TOKENS = (
    r"(?<![A-Za-z0-9_.)^/+-])(?:"
    rf"(?:-?{_MANTISSA}(?:{_BRACKET})?{_POWER}|-?{_MANTISSA}{_BRACKET}(?!e[0-9+-])|-{_MANTISSA}(?!\())"
    r"(?![A-Za-z0-9_]|\.[0-9])"
    r"|(?:n|k|mu|nu)(?= [=<>≤≥] ))"
)
_TOKEN = re.compile(TOKENS)

#: Symbols in the heading of a column.
_SYMBOL = re.compile(r"(?<![A-Za-z0-9_])(?:n|k|E|U|u|mu|nu|kappa)(?![A-Za-z0-9_'])")
_GREEK_WORDS = {"mu", "nu", "kappa"}

#: Characters with a meaning of their own.  [ and * would be taken as arguments of the end of a row.
_SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    "[": "{[}",
    "*": "{*}",
    '"': "{''}",
    "`": "{`}",
}

#: Signs of mathematics by their commands.
_SIGNS = {
    "≤": "leq",
    "≥": "geq",
    "≠": "neq",
    "≈": "approx",
    "≡": "equiv",
    "∼": "sim",
    "∝": "propto",
    "≪": "ll",
    "≫": "gg",
    "±": "pm",
    "∓": "mp",
    "×": "times",
    "÷": "div",
    "·": "cdot",
    "⋅": "cdot",
    "∞": "infty",
    "√": "surd",
    "∂": "partial",
    "∇": "nabla",
    "∫": "int",
    "∑": "sum",
    "∏": "prod",
    "∈": "in",
    "→": "rightarrow",
    "←": "leftarrow",
    "↑": "uparrow",
    "↓": "downarrow",
    "↔": "leftrightarrow",
    "⇒": "Rightarrow",
    "′": "prime",
    "°": "circ",
    "ϵ": "epsilon",
    "ϑ": "vartheta",
    "ϕ": "phi",
    "φ": "varphi",
    "ε": "varepsilon",
    "ϱ": "varrho",
    "ς": "varsigma",
    "µ": "mu",
}

_TEXTS = {
    "−": r"\ensuremath{-}",
    "–": "--",
    "—": "---",
    "‐": "-",
    "‑": "-",
    "…": r"\ldots{}",
    "⁄": "/",
    "‘": "{`}",
    "’": "{'}",
    "“": "{``}",
    "”": "{''}",
    "§": r"\S{}",
    "\N{NO-BREAK SPACE}": "~",
    "ß": r"\ss{}",
    "æ": r"\ae{}",
    "Æ": r"\AE{}",
    "œ": r"\oe{}",
    "Œ": r"\OE{}",
    "ø": r"\o{}",
    "Ø": r"\O{}",
    "ł": r"\l{}",
    "Ł": r"\L{}",
    "ı": r"\i{}",
}

#: Combining accents by their commands.
_ACCENTS = {
    "\u0300": "`",
    "\u0301": "'",
    "\u0302": "^",
    "\u0303": "~",
    "\u0304": "=",
    "\u0306": "u",
    "\u0307": ".",
    "\u0308": '"',
    "\u030a": "r",
    "\u030b": "H",
    "\u030c": "v",
    "\u0323": "d",
    "\u0327": "c",
    "\u0331": "b",
}

#: Greek letters that have a command; the other capitals have the shape of Latin letters.
_CAPITALS = {"GAMMA", "DELTA", "THETA", "LAMBDA", "XI", "PI", "SIGMA", "UPSILON", "PHI", "PSI", "OMEGA"}
_SMALL = _CAPITALS | {"ALPHA", "BETA", "ZETA", "ETA", "IOTA", "KAPPA", "MU", "NU", "RHO", "TAU", "CHI"}
_LATIN = dict(zip("ΑΒΕΖΗΙΚΜΝΟΡΤΧο", "ABEZHIKMNOPTXo", strict=True))
_GREEK_NAME = re.compile(r"GREEK (SMALL|CAPITAL) LETTER (\w+)")


def escaped(text: str) -> str:
    r"""Return a text as LaTeX that gives it back, in ASCII and on one line; its numbers need the package siunitx.

    Examples
    --------
    >>> print(escaped("κ ≤ 5 %, 10⁻³ z₀"))
    \ensuremath{\kappa} \ensuremath{\leq} 5 \%, 10\textsuperscript{\ensuremath{-}}\textsuperscript{3} z\textsubscript{0}
    >>> print(escaped("-0.1 to 2.1e-07 at mu = 1"))
    \num{-0.1} to \num{2.1e-7} at $\mu$ = 1
    """
    plain = unicodedata.normalize("NFC", " ".join(text.split()))
    parts, end = [], 0
    for token in _TOKEN.finditer(plain):
        parts += [_plain(plain[end : token.start()]), _math(token[0])]
        end = token.end()
    return "".join([*parts, _plain(plain[end:])])


def headed(text: str) -> str:
    r"""Return a heading as LaTeX, in which the symbols of parameters, errors and bounds are mathematics.

    Examples
    --------
    >>> print(headed("worst E(U)"), headed("mu"), headed("u_num"))
    worst $E$($U$) $\mu$ u\_num
    """
    parts, end = [], 0
    for symbol in _SYMBOL.finditer(text):
        parts += [_plain(text[end : symbol.start()]), _math(symbol[0])]
        end = symbol.end()
    return "".join([*parts, _plain(text[end:])])


def breakable(latex: str) -> str:
    r"""Return an escaped text that may be broken after an underscore and after a slash, too.

    Examples
    --------
    >>> print(breakable(escaped("pull_off/x")))
    pull\_\allowbreak{}off/\allowbreak{}x
    """
    return latex.replace("\\_", "\\_\\allowbreak{}").replace("/", "/\\allowbreak{}")


def number_text(text: str) -> str:
    """Return a number as siunitx reads it: its power of ten without a plus sign and without leading zeros.

    Examples
    --------
    >>> number_text("-2.1e-07"), number_text("12(3)e+02"), number_text("1.50")
    ('-2.1e-7', '12(3)e2', '1.50')
    """
    return re.sub(r"e(-?)\+?0*([0-9])", r"e\1\2", text)


def _plain(text: str) -> str:
    # Two hyphens would become a dash, and the option of a command could not be copied.
    return "-{}-".join("".join(map(_character, part)) for part in text.split("--"))


def _math(token: str) -> str:
    if token in _GREEK_WORDS:
        return rf"$\{token}$"
    return f"${token}$" if token.isalpha() else rf"\num{{{number_text(token)}}}"


def comment(text: str) -> str:
    r"""Return a text on one line of ASCII, as it stands in a comment.

    Examples
    --------
    >>> comment("50 % and\nmore")
    '50 % and more'
    """
    return "".join(one if one.isascii() and one.isprintable() else _character(one) for one in " ".join(text.split()))


def _character(one: str) -> str:
    if one in _SPECIAL:
        return _SPECIAL[one]
    if one.isascii():
        return one if one.isprintable() else " "
    if one in _TEXTS:
        return _TEXTS[one]
    if one in _SIGNS:
        return rf"\ensuremath{{\{_SIGNS[one]}}}"
    return _greek(one) or _composed(one) or f"{{[}}U+{ord(one):04X}]"


def _greek(one: str) -> str:
    """A Greek letter without an accent; empty for any other character."""
    if one in _LATIN:
        return _LATIN[one]
    named = _GREEK_NAME.fullmatch(unicodedata.name(one, ""))
    if not named:
        return ""
    kind, name = named[1], named[2].replace("LAMDA", "LAMBDA")
    if name not in (_SMALL if kind == "SMALL" else _CAPITALS):
        return ""
    return rf"\ensuremath{{\{name.lower() if kind == 'SMALL' else name.capitalize()}}}"


def _composed(one: str) -> str:
    """A letter with an accent, a superscript, a subscript or another form of known characters; else empty."""
    kind, *codes = (unicodedata.decomposition(one) or "-").split()
    parts = [chr(int(code, 16)) for code in ([] if kind == "-" else codes if kind.startswith("<") else [kind, *codes])]
    if not parts:
        return ""
    if len(parts) == 2 and parts[1] in _ACCENTS:
        return rf"\{_ACCENTS[parts[1]]}{{{_character(parts[0])}}}"
    inner = "".join(map(_character, parts))
    return {"<super>": rf"\textsuperscript{{{inner}}}", "<sub>": rf"\textsubscript{{{inner}}}"}.get(kind, inner)
