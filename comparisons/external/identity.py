"""Name, version and digest of a model, compared between its processes."""

from __future__ import annotations

from typing import Any

from comparisons.external.text_rules import one_line

__all__ = ["DIGEST", "contradiction", "said"]

#: Digits of the digest that are kept in the version of a model.
DIGEST = 12


def contradiction(first: tuple[str, str], later: tuple[str, str]) -> str:
    """Return why a model is refused that is not in a later process what it was in the first.

    Parameters
    ----------
    first, later : tuple of str
        Its name and version; the version ends in a digest of its files.

    Examples
    --------
    >>> contradiction(("mine", "1 (ab)"), ("mine", "1 (cd)"))
    "the model's files changed after it was opened: it is mine 1 (cd) in a later process, and was mine 1 (ab)"
    """
    same = first[0] == later[0] and first[1].rpartition(" (")[0] == later[1].rpartition(" (")[0]
    what = "the model's files changed after it was opened" if same else "the model contradicts itself"
    return one_line(f"{what}: it is {' '.join(later)} in a later process, and was {' '.join(first)}")


def said(opened: dict[str, Any]) -> tuple[str, str]:
    """Return name and version of a model as its process gave them, the version with the digest."""
    name, version, digest = (one_line(str(opened.get(key)), 60) for key in ("name", "version", "digest"))
    return name, f"{version} ({digest[:DIGEST]})"
