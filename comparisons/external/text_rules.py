"""Text rules for external models: a name keeps a pattern, any other text is one short printable line."""

from __future__ import annotations

import re

from comparisons.console.printable import without_piles

#: Texts that every model states of itself.
TEXTS = ("name", "version", "citation", "domain")

#: Names become file names, table cells, HTML and command lines, and must be harmless in all of them.
_NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")

#: "given" stands in gates for every model of --model; programs that read CSV take the others for a missing value.
_TAKEN = ("given", "nan", "na", "n-a", "null", "none", "nil")

#: A file or folder that every system can hold: others have spaces, shell characters or letters that look alike.
_PORTABLE = re.compile(r"[A-Za-z0-9._][A-Za-z0-9._-]{0,99}(?<!\.)")
#: Names of devices, with any ending, on Windows, where a clone of the repository would fail.
_DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in range(10))}

#: Letters and digits of ASCII that look alike, and signs between words.
_LOOK_ALIKE = str.maketrans({"0": "o", "1": "l", "i": "l", ".": "-", "_": "-"})


def is_portable(name: str) -> bool:
    """Whether a file or a folder may have a name on every system.

    Examples
    --------
    >>> [is_portable(name) for name in ("model.py", "__init__.py", "Aux.csv", "a b", "x.", "..", "mod\u0435l.py")]
    [True, True, False, False, False, False, False]
    """
    return bool(_PORTABLE.fullmatch(name)) and name.lower().partition(".")[0] not in _DEVICES


def appearance(name: str) -> str:
    """Return what names that look alike have in common.

    Examples
    --------
    >>> appearance("md_lmpr0ved") == appearance("md-improved")
    True
    """
    return name.lower().translate(_LOOK_ALIKE).replace("rn", "m").replace("vv", "w")


def model_name(text: str) -> str:
    """Return the name of a model if it is admissible.

    Raises
    ------
    ValueError
        If it is not 1 to 64 letters, digits, dots, hyphens and underscores, the first a letter or a digit.

    Examples
    --------
    >>> model_name("double-hertz")
    'double-hertz'
    """
    if text.lower() in _TAKEN:
        raise ValueError(f"the model's name {text} has a meaning of its own in gates or tables; choose another name")
    if not _NAME_PATTERN.fullmatch(text):
        raise ValueError(
            f"the model's name {one_line(repr(text), 60)} is not 1 to 64 letters, digits, '.', '_' and '-' beginning "
            "with a letter or a digit: it becomes a file name and a cell of tables"
        )
    return text


def one_line(text: str, longest: int = 500) -> str:
    r"""Return a text as one line without control characters, cut to at most `longest` characters.

    Examples
    --------
    >>> one_line("two\nlines \x1b[31m")
    'two lines [31m'
    """
    # Only the beginning of a long text is read.
    words = text[: 4 * longest].split()
    line = without_piles(" ".join("".join(filter(str.isprintable, word)) for word in words))
    return line if len(line) <= longest else line[: longest - 3] + "..."
