"""Words that the glossary replaces, in code, docs and tests."""

import re
from pathlib import Path

from tests.paths import ROOT

GLOSSARY = ROOT / "docs" / "ARCHITECTURE.md"
SUFFIXES = {".py", ".md", ".toml", ".json", ".html", ".js", ".css", ".in", ".cff"}
#: The glossary itself, and the record of what was renamed.
EXEMPT = {GLOSSARY, ROOT / "CHANGELOG.md", Path(__file__).resolve()}


def replaced_words() -> list[str]:
    """The first column of the glossary's table."""
    _, _, section = GLOSSARY.read_text(encoding="utf-8").partition("## Glossary")
    rows = [line.split("|")[1] for line in section.splitlines() if line.startswith("| `")]
    return [word for row in rows for word in re.findall(r"`([^`]+)`", row)]


def patterns() -> list[re.Pattern[str]]:
    """Whole words, but not `ast.walk` and `os.walk`; a capital or an underscore makes it a name, whose case counts."""
    words = replaced_words()
    names = [word for word in words if word != word.lower() or "_" in word]
    groups = (names, 0), ([word for word in words if word not in names], re.IGNORECASE)
    return [
        re.compile(rf"(?<!\w)(?<!\bast\.)(?<!\bos\.)(?:{'|'.join(map(re.escape, group))})(?!\w)", flags)
        for group, flags in groups
    ]


def texts() -> dict[Path, str]:
    folders = [ROOT / name for name in ("fscm", "fem_reference", "comparisons", "docs", "tests")]
    files = [path for folder in folders for path in folder.rglob("*") if path.suffix in SUFFIXES]
    # What a build of the site writes.
    files = [path for path in files if "_generated" not in path.parts]
    files += [path for path in ROOT.glob("*.*") if path.suffix in SUFFIXES]
    return {path: path.read_text(encoding="utf-8") for path in files if path not in EXEMPT}


def test_a_replaced_word_is_not_used():
    expressions = patterns()
    uses = [
        f"{path.relative_to(ROOT)}: {use[0]}"
        for path, text in texts().items()
        for expression in expressions
        for use in expression.finditer(text)
    ]
    assert uses == []
