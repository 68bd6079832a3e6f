"""Name and version of a model, compared between its processes."""

from __future__ import annotations

from comparisons.external.text_rules import one_line

__all__ = ["contradiction"]


def contradiction(first: tuple[str, str], later: tuple[str, str]) -> str:
    """Return the sentence for a model whose name, version or files are not the same in a later process.

    Parameters
    ----------
    first, later : tuple of str
        Its name and version; the version ends in a digest of its files.

    Examples
    --------
    >>> contradiction(("mine", "1 (ab)"), ("mine", "1 (cd)"))
    "the model's files changed after it was loaded: it is mine 1 (cd) in a later process, and was mine 1 (ab)"
    """
    same = first[0] == later[0] and first[1].rpartition(" (")[0] == later[1].rpartition(" (")[0]
    what = "files" if same else "name or version"
    now = f"it is {' '.join(later)} in a later process, and was {' '.join(first)}"
    return one_line(f"the model's {what} changed after it was loaded: {now}")
