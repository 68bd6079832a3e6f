"""Check before a release: the tag, the version, the address and the change log agree, and it can be cited.

python .github/release_check.py v0.2.0 https://github.com/OWNER/REPO     # needs PyYAML
"""

import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).resolve().parents[1]

#: Begins what only the owner of the repository can write in `paper.md`.
OWNER = "[to be stated by the owner"
#: Keys of which one names an author of `paper.md`; the rules of the journal give these.
AUTHOR = ("name", "surname", "family", "literal")


def problems(tag: str, address: str) -> list[str]:
    """Return what does not agree or is missing, one sentence each."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    paper = (ROOT / ".github" / "joss" / "paper.md").read_text(encoding="utf-8")
    return [
        *_version(tag, project["version"], citation),
        *_address(address, project.get("urls", {}).get("Source"), citation.get("repository-code")),
        *_citation(citation),
        *_paper(yaml.safe_load(paper.split("---", 2)[1]), paper),
    ]


def _version(tag: str, version: str, citation: dict[str, Any]) -> Iterator[str]:
    if tag != f"v{version}":
        yield f"the tag is {tag}, and the version in pyproject.toml {version}"
    if str(citation.get("version")) != version:
        yield f"CITATION.cff has not the version {version}"
    headings = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    if not any(heading.split()[0] == version for heading in headings):
        yield f"CHANGELOG.md has no section {version}"


def _address(address: str, source: str | None, cited: str | None) -> Iterator[str]:
    if source != address:
        stated = f"the address in pyproject.toml is {source}" if source else "pyproject.toml has no [project.urls]"
        yield f'{stated}, and this repository is {address}: write [project.urls] with Source = "{address}"'
    if cited != address:
        stated = f"the address in CITATION.cff is {cited}" if cited else "CITATION.cff has no address"
        yield f'{stated}, and this repository is {address}: write repository-code: "{address}"'


def _citation(citation: dict[str, Any]) -> Iterator[str]:
    if not any(author.get("family-names") for author in citation.get("authors") or []):
        yield "CITATION.cff has no family name of an author: a citation needs one"
    if not re.fullmatch(r"10\.\d+/\S+", str(citation.get("doi"))):
        yield "CITATION.cff has no line `doi: 10...`: reserve the DOI of the release first, at Zenodo for example"


def _paper(head: dict[str, Any], text: str) -> Iterator[str]:
    """What the paper lacks: persons, where they work, and the sections that only the owner can write."""
    authors = head.get("authors") or []
    if not any(author.get(key) for author in authors for key in AUTHOR):
        yield "paper.md has no author"
    known = {str(place.get("index")) for place in head.get("affiliations") or [] if place.get("name")}
    if not known:
        yield "paper.md has no affiliation with an index and a name"
    for author in authors:
        stated = {index.strip() for index in str(author.get("affiliation", "")).split(",")}
        if known and not stated <= known:
            yield f"paper.md: the affiliation of {author} is not among the indices {', '.join(sorted(known))}"
    for section in re.split(r"^# ", text, flags=re.MULTILINE)[1:]:
        if OWNER in section:
            yield f"paper.md: the section {section.splitlines()[0]} is to be written by the owner of the repository"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("two arguments are needed: the tag, and the address of the repository")
    sys.exit("\n".join(problems(*sys.argv[1:])) or 0)
