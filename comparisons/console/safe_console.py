"""Console whose texts have no control characters but its own."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NoReturn

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment

from comparisons.console.printable import printable


class SafeConsole(Console):
    """Console of rich that shows control characters of texts by their numbers, and raises `BrokenPipeError`."""

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """Yield the segments of an object; what rich itself tells the terminal is not a text."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else segment._replace(text=printable(segment.text))

    def on_broken_pipe(self) -> NoReturn:
        """Raise an error: rich would end the process with status 1."""
        raise BrokenPipeError
