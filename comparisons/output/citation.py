"""Citation of fscm-bench and of what a run used, as text and as BibTeX."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any, NamedTuple

from comparisons.data.toml_text import shipped
from comparisons.output.latex import escaped
from comparisons.runs.environment import DIGITS, version_of

#: Entries of a work, in the order of BibTeX.
_ENTRIES = ("author", "title", "journal", "publisher", "volume", "pages", "year", "doi", "url", "note")


class Work(NamedTuple):
    """A work to cite: its key, and its facts in plain text; `author` has names separated by " and ".

    Examples
    --------
    >>> Work("jkr", {"title": "JKR", "note": "version 1"}).text()
    'JKR. version 1.'
    """

    key: str
    entries: Mapping[str, Any]

    @property
    def filled(self) -> dict[str, str]:
        """The entries of BibTeX that are not empty, in its order."""
        return {name: str(self.entries[name]) for name in _ENTRIES if self.entries.get(name)}

    def text(self) -> str:
        """The work in one line."""
        entry = dict.fromkeys(_ENTRIES, "") | self.filled
        authors = entry["author"].strip("{}").replace(" and others", " et al.").replace(" and ", "; ")
        year = f"({entry['year']})" if entry["year"] else ""
        venue = entry["journal"] or entry["publisher"]
        where = " ".join(filter(None, [venue, entry["volume"], year, entry["pages"].replace("--", "-")]))
        doi = f"doi:{entry['doi']}" if entry["doi"] else ""
        sentences = [authors, entry["title"], where, doi, entry["note"], entry["url"]]
        return " ".join(f"{sentence.rstrip('.')}." for sentence in sentences if sentence)

    def bibtex(self) -> str:
        """The work as an entry of BibTeX, in ASCII."""
        kind = "article" if "journal" in self.filled else "book" if "publisher" in self.filled else "misc"
        lines = [f"  {name} = {{{_field(name, value)}}}," for name, value in self.filled.items()]
        return "\n".join([f"@{kind}{{{self.key},", *lines, "}"])


def _field(name: str, value: str) -> str:
    if name in ("doi", "url", "pages"):
        return value
    # An institution is one name: its braces stay.  A second pair of braces keeps the capitals of a title.
    text = escaped(value.strip("{}"))
    return f"{{{text}}}" if name == "title" or value.startswith("{") else text


def works(version: str, record: Mapping[str, Any] | None = None) -> list[Work]:
    """Return what to cite: fscm-bench, the paper whose model it computes, and for a run what it used.

    Parameters
    ----------
    version : str
        Of fscm-bench, with its commit if that is known; of a run it is that of the record.
    record : mapping, optional
        Of a run, as `comparisons.runs.record.read_record` returns it.

    Examples
    --------
    >>> [work.key for work in works("0.1.0")]
    ['fscm-bench', 'zhu-adhesion']
    """
    cff = _shipped("citation.json")
    note = f"version {version_of(record['package']) if record else version}"
    facts = {"author": _names(cff["authors"]), "year": cff["date-released"][:4], "note": note}
    cited = [Work("fscm-bench", cff | facts | {"url": cff.get("repository-code")})]
    for paper in cff["references"]:
        key = f"{paper['authors'][0].get('family-names', '')}-{paper['title'].split()[0]}".lower()
        pages = "--".join(str(paper[name]) for name in ("start", "end") if name in paper)
        cited.append(Work(key, paper | {"author": _names(paper["authors"]), "pages": pages}))
    used = (record or {}).get("models") or {}
    listed = shipped("model_references.toml")
    keys = dict.fromkeys(key for name in used for key in listed["models"].get(name, ()))
    cited += [Work(key, listed["works"][key]) for key in keys if key not in {work.key for work in cited}]
    for name, model in used.items():
        if name not in listed["models"]:
            title = f"Model {name}, version {model['version']}"
            key = "model-" + re.sub("[^A-Za-z0-9-]", "-", name)
            # The contract has the citation as one text; BibTeX sorts by the author.
            author = f"{{[author of {name}, to be filled in]}}"
            cited.append(Work(key, {"author": author, "title": title, "note": model["citation"]}))
    for library in _libraries(record) if record else ():
        facts = {"author": " and ".join(library["authors"]), "note": f"version {library['version']}"}
        cited.append(Work(library["package"], library | facts))
    return cited


def _shipped(name: str) -> Any:
    return json.loads(files("comparisons.data").joinpath(name).read_text(encoding="utf-8"))


def _libraries(record: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the libraries that the models of a run use, each with its version."""
    models = record.get("models") or {}
    return [
        library | {"version": record["dependencies"][library["package"]]}
        for library in _shipped("software_references.json")
        if library["models"] is None or not models.keys().isdisjoint(library["models"])
    ]


def methods(record: Mapping[str, Any], references: Mapping[str, float]) -> str:
    """Return a paragraph for the section Methods of a paper.

    Parameters
    ----------
    record : mapping
        Of a run, as `comparisons.runs.record.read_record` returns it.
    references : mapping of str to float
        Model that was a reference -> largest bound on its numerical error, relative to its value.
    """
    models, package = record.get("models") or {}, record["package"]
    named = {name: f"{name} (version {model['version']})" for name, model in models.items()}
    *others, last = [text for name, text in named.items() if name not in references] or [""]
    judged = f"{', '.join(others)} and {last}" if others else last
    reference = "; ".join(
        f"{named[name]}, whose numerical error is at most {bound:.1g} of its value"
        for name, bound in references.items()
        if name in named
    )
    libraries = ", ".join(f"{library['name']} {library['version']}" for library in _libraries(record))
    digest = f", code with the SHA-256 {package['code_sha256'][:DIGITS]}" if "code_sha256" in package else ""
    verdict = record["verdicts"].get("all")
    sentences = [
        f"The errors of {judged} were computed with fscm-bench {version_of(package)}{digest}." if judged else "",
        f"The reference is {reference}." if reference else "",
        "Errors are kappa = (model - reference) / |reference|; the bounds on the numerical errors of model and "
        "reference add to the bound on kappa.",
        f"There are {record['rows']['all']} results.",
        f"The verdict over all gates is {verdict}." if verdict else "",
        f"The run began on {record['started'][:10]} and used Python {record['machine']['python']}, {libraries}.",
    ]
    return " ".join(filter(None, sentences))


def as_text(cited: Sequence[Work], paragraph: str = "") -> str:
    """Return the paragraph, if there is one, and the works, one a line.

    Examples
    --------
    >>> print(as_text([Work("a", {"title": "A"})], "We used A."), end="")
    We used A.
    <BLANKLINE>
    [1] A.
    """
    lines = [f"[{number}] {work.text()}" for number, work in enumerate(cited, start=1)]
    return "\n".join([*([paragraph, ""] if paragraph else []), *lines]) + "\n"


def as_bibtex(cited: Sequence[Work]) -> str:
    r"""Return the works as BibTeX.

    Examples
    --------
    >>> print(as_bibtex([Work("a", {"title": "A & B"})]), end="")
    @misc{a,
      title = {{A \& B}},
    }
    """
    return "\n\n".join(work.bibtex() for work in cited) + "\n"


def _names(authors: Sequence[Mapping[str, str]]) -> str:
    """Names as BibTeX has them; the name of an institution stands in braces."""
    return " and ".join(
        f"{author['family-names']}, {author['given-names']}" if "family-names" in author else f"{{{author['name']}}}"
        for author in authors
    )
