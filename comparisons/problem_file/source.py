"""Text of a problem file with the lines of its keys, for sentences that refuse it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date, time
from pathlib import Path

__all__ = ["Source", "read_text", "shortened", "shown"]

#: Longest value that a sentence shows in full.
_LONGEST = 60


def read_text(path: Path, what: str) -> str:
    """Return the text of a file.

    Raises
    ------
    ValueError
        One sentence, if it cannot be read or is not UTF-8.

    Examples
    --------
    >>> read_text(Path("no_such_file.toml"), "the problem file")
    Traceback (most recent call last):
    ValueError: no_such_file.toml: the problem file cannot be read (No such file or directory); check the name
    """
    if str(path) == "-":
        raise ValueError(f"-: {what} is not read from the standard input; give the name of a file")
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        raise ValueError(
            f"{path}, line {line}: the byte 0x{error.object[error.start]:02x} is not UTF-8; save the file as UTF-8"
        ) from None
    except (OSError, ValueError) as error:
        # A name with a NUL is a `ValueError`.
        reason = getattr(error, "strerror", None) or error
        raise ValueError(f"{path}: {what} cannot be read ({reason}); check the name") from None


@dataclass(frozen=True, slots=True)
class Source:
    r"""A problem file.

    Examples
    --------
    >>> source = Source(Path("pad.toml"), "[solid]\nkind = 'power-law'\nE0 = -1\n")
    >>> source.refusal("solid", "E0", "E0 = -1 must be positive")
    ValueError('pad.toml, line 3: [solid] E0 = -1 must be positive')
    """

    path: Path
    text: str
    tables: Mapping[str, Path] = field(default_factory=dict)

    def table(self, name: str) -> Path:
        """Return the path of a table that the file names: beside the file, or its copy in `tables`."""
        return self.tables.get(name, self.path.parent / name)

    def line(self, section: str, key: str | None = None) -> int | None:
        """Line of a key, or else of its section; None where neither is written on a line of its own."""
        header = re.compile(rf"\s*(\[{{1,2}}\s*[\"']?{re.escape(section)}[\"']?\s*\]|{re.escape(section)}\s*[.=])")
        entry = re.compile(rf"\s*({re.escape(section)}\s*\.\s*)?[\"']?{re.escape(key or '')}[\"']?\s*[.=]")
        found, inside = None, False
        for number, line in enumerate(self.text.splitlines(), start=1):
            begins = bool(header.match(line))
            inside = begins or (inside and not line.lstrip().startswith("["))
            if begins and found is None:
                found = number
            if key is not None and inside and entry.match(line):
                return number
        return found

    def refusal(self, section: str, key: str | None, sentence: str) -> ValueError:
        """Return the error with file, line and section before its sentence."""
        line = self.line(section, key)
        place = f"{self.path}, line {line}" if line else str(self.path)
        return ValueError(f"{place}: [{section}] {sentence}")


def shown(value: object) -> str:
    """Return a value as a sentence shows it.

    Examples
    --------
    >>> shown(True), shown("2 GPa")
    ('true', '"2 GPa"')
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, date | time):
        return value.isoformat()
    return shortened(f'"{ascii(value)[1:-1]}"' if isinstance(value, str) else ascii(value))


def shortened(text: str) -> str:
    """Return a text that is not too long for a sentence.

    Examples
    --------
    >>> shortened("pad.toml"), len(shortened("x" * 5000))
    ('pad.toml', 60)
    """
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
