"""Texts on the data of a module, which have no docstring, for the API reference."""

from __future__ import annotations

import ast
from functools import cache
from itertools import takewhile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

#: The packages, in the order of the reference.
PACKAGES = ("fscm", "fem_reference", "comparisons")


@cache
def texts_of(path: Path, *, imported: bool = True) -> dict[str, str]:
    """Text of each datum of a module: the comment ``#:`` before it, or that where it comes from if it is imported.

    Examples
    --------
    >>> texts_of(ROOT / "comparisons" / "console" / "exit_status.py")["OK"] != ""
    True
    """
    text = path.read_text(encoding="utf-8")
    lines, body = text.splitlines(), ast.parse(text).body
    found = {}
    for statement in body:
        match statement:
            case ast.Assign(targets=targets):
                pass
            case ast.AnnAssign(target=target):
                targets = [target]
            case ast.ImportFrom(module=str(module), level=0) if imported and module.partition(".")[0] in PACKAGES:
                found |= _imported(module, {alias.asname or alias.name: alias.name for alias in statement.names})
                continue
            case _:
                continue
        names = [node.id for target in targets for node in ast.walk(target) if isinstance(node, ast.Name)]
        found |= dict.fromkeys(names, _before(lines[: statement.lineno - 1]))
    return found


def _imported(module: str, names: dict[str, str]) -> dict[str, str]:
    """Texts of a module by the names that another one has imported them as."""
    path = (ROOT / Path(*module.split("."))).with_suffix(".py")
    texts = texts_of(path) if path.is_file() else {}
    return {own: texts[name] for own, name in names.items() if texts.get(name)}


def _before(lines: list[str]) -> str:
    """The comment ``#:`` that ends these lines."""
    comments = list(takewhile(lambda line: line.startswith("#:"), reversed(lines)))
    return " ".join(line.removeprefix("#:").strip() for line in reversed(comments))
