"""Tables in GitHub's Markdown, and the summary page of a GitHub Actions job."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pandas as pd

__all__ = ["markdown", "to_step_summary"]

#: What a table, HTML or Markdown takes for its own, and the starts of addresses that become links without any mark.
_OWN = {
    **{"&": "&amp;", "<": "&lt;", ">": "&gt;", "|": "\\|", "\n": " "},
    **{character: f"&#{ord(character)};" for character in "\\`*[]!~"},
    **{"://": "&#58;//", "www.": "www&#46;", "@": "&#64;<!-- -->"},
}
_OWN_TEXT = re.compile("|".join(map(re.escape, _OWN)), re.IGNORECASE)


def markdown(texts: pd.DataFrame, title: str) -> str:
    r"""Return a table of texts as Markdown.

    Examples
    --------
    >>> print(markdown(pd.DataFrame({"gate": ["A|B"], "verdict": ["PASS"]}), "Verdicts"), end="")
    ## Verdicts
    <BLANKLINE>
    | gate | verdict |
    | --- | --- |
    | A\|B | PASS |
    """
    head, *rows = ([_escaped(str(cell)) for cell in row] for row in [list(texts), *texts.to_numpy().tolist()])
    lines = [f"| {' | '.join(cells)} |" for cells in (head, ["---"] * len(head), *rows)]
    return "\n".join([f"## {_escaped(title)}", "", *lines, ""])


def _escaped(text: str) -> str:
    """Text that neither a table nor HTML nor Markdown takes for its own."""
    return _OWN_TEXT.sub(lambda match: _OWN.get(match[0]) or f"{match[0][:-1]}&#46;", text)


def to_step_summary(text: str) -> None:
    """Append to the summary page if this is a job of GitHub Actions.

    An empty text only makes sure, before anything is computed, that the page can be written.

    Raises
    ------
    OSError
        If it cannot; one sentence gives the system's reason.
    """
    path = os.environ.get("GITHUB_STEP_SUMMARY")
    if path:
        try:
            with Path(path).open("a", encoding="utf-8") as file:
                file.write(text)
        except OSError as error:
            raise OSError(
                f"the file {path}, which the environment variable GITHUB_STEP_SUMMARY names, cannot be written "
                f"({error.strerror}); unset the variable or name another file"
            ) from error
