"""Length of the sentences of the README and of the pages."""

import re

import pytest

from tests.docs.test_documents import DOCUMENTS
from tests.paths import ROOT

#: Most words of a sentence.
MOST_WORDS = 40
#: Longer ones are left to the record of changes.
RECORD = {"CHANGELOG.md"}
PAGES = [page for page in DOCUMENTS if page.name not in RECORD] + sorted((ROOT / ".github").rglob("*.md"))
#: A reference to the literature, which is no sentence.
REFERENCE = "Please cite"


def sentences(text):
    """The sentences of a page: without code, tables, formulas, comments and targets of links."""
    text = re.sub(r"^```.*?^```", "\n", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"<!--.*?-->|<picture>.*?</picture>", "\n", text, flags=re.DOTALL)
    text = re.sub(r"^ *\|.*$", "\n", text, flags=re.MULTILINE)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"\$\$.*?\$\$|\$[^$\n]*\$|`[^`]*`", "X", text, flags=re.DOTALL)
    for paragraph in re.split(r"\n\s*(?:[*-]|\d+\.) |\n\s*\n|\n#+ |\n {4}", text):
        yield from re.split(r"(?<=[.!?])[\s*)\"]+(?=[A-Z`(\[*\d])", " ".join(paragraph.split()))


def words(sentence):
    return sum(bool(re.search(r"\w", word)) for word in sentence.split())


def test_sentences_are_told_apart():
    text = "One of `a. B` and [two\nwords](x.md).  Then 3 = 3.\n\n| a | table |\n\n"
    text += "* An item: with\n  two lines\n* Another\n"
    assert [sentence for sentence in sentences(text) if words(sentence)] == [
        "One of X and two words.",
        "Then 3 = 3.",
        "An item: with two lines",
        "Another",
    ]
    assert words("a - b = 1, X") == 4


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_no_sentence_is_long(page):
    long = [sentence for sentence in sentences(page.read_text(encoding="utf-8")) if words(sentence) > MOST_WORDS]
    assert [sentence for sentence in long if not sentence.startswith(REFERENCE)] == []
