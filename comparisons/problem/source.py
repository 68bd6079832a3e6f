"""Text of a problem file with the lines of its keys, for sentences that refuse it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Source:
    r"""A problem file.

    Examples
    --------
    >>> source = Source(Path("pad.toml"), "[solid]\nkind = 'power-law'\nE0 = -1\n")
    >>> source.refusal("solid.E0 = -1 must be positive", "solid", "E0")
    ValueError('pad.toml, line 3: solid.E0 = -1 must be positive')
    """

    path: Path
    text: str

    def place(self, section: str, key: str | None = None) -> str:
        """File and line of a key, or else of its section; the file where neither is written on a line of its own."""
        table, name = re.escape(section), re.escape(key or "kind")
        header = re.compile(rf"\s*(\[{{1,2}}\s*[\"']?{table}[\"']?\s*\]|{table}\s*[.=])")
        entry = re.compile(rf"\s*({table}\s*\.\s*)?[\"']?{name}[\"']?\s*[.=]")
        line_of_section, inside = 0, False
        for number, line in enumerate(self.text.splitlines(), start=1):
            begins = bool(header.match(line))
            inside = begins or (inside and not line.lstrip().startswith("["))
            line_of_section = line_of_section or number * begins
            if key and inside and entry.match(line):
                return f"{self.path}, line {number}"
        return f"{self.path}, line {line_of_section}" if line_of_section else str(self.path)

    def refusal(self, sentence: str, section: str, key: str | None = None) -> ValueError:
        """Return the error with file and line before its sentence."""
        return ValueError(f"{self.place(section, key)}: {sentence}")
