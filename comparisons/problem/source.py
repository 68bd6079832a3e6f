"""Text of a problem file with the lines of its keys, for sentences that refuse it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import date, time
from pathlib import Path

from comparisons.data.contained_paths import path_inside

__all__ = ["Source", "shortened", "shown"]

#: Longest value that a sentence shows in full.
_LONGEST = 60


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

    def table(self, section: str, name: str) -> Path:
        """Return the path of a table that a section names, which is in the folder of the file; otherwise refuse it."""
        try:
            return path_inside(self.path.parent, name)
        except ValueError:
            raise self.refusal(
                section,
                "file",
                f"file = {shown(name)} is not in the folder of {self.path.name}; put the table beside the problem file",
            ) from None

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
