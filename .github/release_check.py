"""Check before a release: the tag, the version, the address and the change log agree, and it can be cited.

python .github/release_check.py v0.2.0 https://github.com/OWNER/REPO
"""

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def problems(tag: str, address: str) -> list[str]:
    """Return what does not agree, one sentence each."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    version = project["version"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8").partition("\nreferences:")[0]
    cited = re.search(r"^version: (.*)$", citation, flags=re.MULTILINE)
    headings = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    found = []
    if tag != f"v{version}":
        found.append(f"the tag is {tag}, and the version in pyproject.toml {version}")
    if cited is None or cited[1] != version:
        found.append(f"CITATION.cff has not the version {version}")
    if not any(heading.split()[0] == version for heading in headings):
        found.append(f"CHANGELOG.md has no section {version}")
    source = project.get("urls", {}).get("Source")
    if source != address:
        stated = f"the address in pyproject.toml is {source}" if source else "pyproject.toml has no [project.urls]"
        found.append(f'{stated}, and this repository is {address}: write [project.urls] with Source = "{address}"')
    found += [f"{name} has no family name of an author: a citation needs one" for name in _anonymous(citation)]
    if not re.search(r"^doi: 10\.\d+/\S+$", citation, flags=re.MULTILINE):
        found.append(
            "CITATION.cff has no line `doi: 10...`: reserve the DOI of the release first, at Zenodo for example"
        )
    return found


def _anonymous(citation: str) -> list[str]:
    """The files that name no person."""
    paper = (ROOT / ".github" / "joss" / "paper.md").read_text(encoding="utf-8")
    missing = [] if re.search(r"^  - family-names: \S", citation, flags=re.MULTILINE) else ["CITATION.cff"]
    return missing + ([] if re.search(r"^  - name: \S", paper, flags=re.MULTILINE) else ["paper.md"])


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("two arguments are needed: the tag, and the address of the repository")
    sys.exit("\n".join(problems(*sys.argv[1:])) or 0)
