"""Citation of fscm-bench and of what a run used, as text and as BibTeX."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from typing import Any

from comparisons.output.latex import escaped

__all__ = ["Work", "as_bibtex", "as_text", "methods", "works"]

#: Commit and digest are shortened to this many characters, as Git does.
_SHORT = 12


@dataclass(frozen=True, slots=True)
class Work:
    """A work to cite.

    Attributes
    ----------
    key : str
        Of the BibTeX entry.
    kind : str
        "article" or "misc".
    entries : mapping of str to str
        The fields of the entry, in plain text; `author` has its names separated by " and ".

    Examples
    --------
    >>> Work("jkr", "misc", {"title": "JKR", "note": "version 1"}).text()
    'JKR. version 1.'
    """

    key: str
    kind: str
    entries: Mapping[str, str] = field(default_factory=dict)

    def text(self) -> str:
        """The work in one line."""
        entries = self.entries
        authors = entries.get("author", "").strip("{}").replace(" and others", " et al.").replace(" and ", "; ")
        where = " ".join(entries[name] for name in ("journal", "volume") if name in entries)
        when = f"({entries['year']})" if "year" in entries else ""
        place = " ".join(part for part in (where, when, entries.get("pages", "").replace("--", "-")) if part)
        doi = f"doi:{entries['doi']}" if "doi" in entries else ""
        rest = [entries.get(name, "") for name in ("note", "url")]
        parts = [authors, entries.get("title", ""), place, doi, *rest]
        return " ".join(f"{part.rstrip('.')}." for part in parts if part)

    def bibtex(self) -> str:
        """The work as an entry of BibTeX, in ASCII."""
        lines = [f"  {name} = {{{_field(name, value)}}}," for name, value in self.entries.items()]
        return "\n".join([f"@{self.kind}{{{self.key},", *lines, "}"])


def _field(name: str, value: str) -> str:
    if name in ("doi", "url", "pages"):
        return value
    # An institution is one name: its braces stay.
    inner = escaped(value.strip("{}"))
    # A second pair of braces keeps the capitals of a title.
    return f"{{{inner}}}" if name == "title" or value.startswith("{") else inner


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
    cff = json.loads(_data("citation.json"))
    note = f"version {_version(record['package']) if record else version}"
    own = {"author": _names(cff["authors"]), "title": cff["title"], "note": note}
    found = [Work("fscm-bench", "misc", own | _some(cff, "year", "doi", "url"))]
    found += [_article(reference) for reference in cff["references"]]
    if record:
        models = record.get("models") or {}
        found += [_of_model(name, model) for name, model in models.items()]
        found += [
            _of_software(one, record) for one in json.loads(_data("software_references.json")) if _used(one, models)
        ]
    return found


def methods(record: Mapping[str, Any], references: Mapping[str, float]) -> str:
    """Return a paragraph for the section Methods of a paper.

    Parameters
    ----------
    record : mapping
        Of a run, as `comparisons.runs.record.read_record` returns it.
    references : mapping of str to float
        Model that was a reference -> largest bound on its numerical error, relative to its value.
    """
    models = record.get("models") or {}
    judged = [f"{name} (version {model['version']})" for name, model in models.items() if name not in references]
    bounds = [
        f"{name} (version {models[name]['version']}), whose numerical error is at most {bound:.1g} of its value"
        for name, bound in references.items()
        if name in models
    ]
    rows = record["rows"]
    dependencies = record["dependencies"]
    libraries = ", ".join(
        f"{name} {dependencies[package]}"
        for package, name in (("numpy", "NumPy"), ("scipy", "SciPy"), ("scikit-fem", "scikit-fem"), ("pyamg", "pyamg"))
        if package in dependencies and (package in ("numpy", "scipy") or "fem" in models)
    )
    verdict = record["verdicts"].get("overall")
    sentences = [
        f"The errors of {_listed(judged)} were computed with {_named(record['package'])}." if judged else "",
        f"The reference is {_listed(bounds)}." if bounds else "",
        "Errors are kappa = (model - reference) / |reference|; the bounds on the numerical errors of model and "
        "reference add to the bound on kappa.",
        f"There are {rows['all']} results.",
        f"The verdict over all gates is {verdict}." if verdict else "",
        f"The run began on {record['started'][:10]} and used Python {record['python']}, {libraries}.",
    ]
    return " ".join(sentence for sentence in sentences if sentence)


def as_text(found: Sequence[Work], paragraph: str = "") -> str:
    """Return the paragraph, if there is one, and the works, one a line.

    Examples
    --------
    >>> print(as_text([Work("a", "misc", {"title": "A"})], "We used A."), end="")
    We used A.
    <BLANKLINE>
    [1] A.
    """
    lines = [f"[{number}] {work.text()}" for number, work in enumerate(found, start=1)]
    return "\n".join([*([paragraph, ""] if paragraph else []), *lines]) + "\n"


def as_bibtex(found: Sequence[Work]) -> str:
    r"""Return the works as BibTeX.

    Examples
    --------
    >>> print(as_bibtex([Work("a", "misc", {"title": "A & B"})]), end="")
    @misc{a,
      title = {{A \& B}},
    }
    """
    return "\n\n".join(work.bibtex() for work in found) + "\n"


def _data(name: str) -> str:
    return files("comparisons.data").joinpath(name).read_text(encoding="utf-8")


def _names(authors: Sequence[Mapping[str, str]]) -> str:
    """Names as BibTeX has them; the name of an institution stands in braces."""
    return " and ".join(
        f"{author['family-names']}, {author['given-names']}" if "family-names" in author else f"{{{author['name']}}}"
        for author in authors
    )


def _some(source: Mapping[str, Any], *names: str) -> dict[str, str]:
    return {name: str(source[name]) for name in names if source.get(name)}


def _article(reference: Mapping[str, Any]) -> Work:
    (first, *_), title = reference["authors"], reference["title"]
    key = f"{first.get('family-names', first.get('name', ''))}-{title.split()[0]}".lower()
    pages = "--".join(str(reference[name]) for name in ("start", "end") if name in reference)
    entries = {"author": _names(reference["authors"]), "title": title}
    entries |= _some(reference, "journal", "volume") | ({"pages": pages} if pages else {})
    entries |= _some(reference, "year", "doi", "url")
    return Work(key, "article" if "journal" in reference else "misc", entries)


def _of_model(name: str, model: Mapping[str, Any]) -> Work:
    """The model of a run, by the citation that it states."""
    key = "model-" + re.sub(r"[^A-Za-z0-9-]", "-", name)
    return Work(key, "misc", {"title": f"Model {name}, version {model['version']}", "note": model["citation"]})


def _of_software(one: Mapping[str, Any], record: Mapping[str, Any]) -> Work:
    entries = {"author": " and ".join(one["authors"]), "title": one["title"]}
    entries |= _some(one, "journal", "volume", "pages", "year", "doi")
    return Work(one["package"], "article", entries | {"note": f"version {record['dependencies'][one['package']]}"})


def _used(one: Mapping[str, Any], models: Mapping[str, Any]) -> bool:
    return one["models"] is None or not models.keys().isdisjoint(one["models"])


def _version(package: Mapping[str, Any]) -> str:
    if not package.get("commit"):
        return str(package["version"])
    changed = " with changes" if package.get("dirty") else ""
    return f"{package['version']} (commit {package['commit'][:_SHORT]}{changed})"


def _named(package: Mapping[str, Any]) -> str:
    digest = f", code with the SHA-256 {package['code_sha256'][:_SHORT]}" if "code_sha256" in package else ""
    return f"fscm-bench {_version(package)}{digest}"


def _listed(items: Sequence[str]) -> str:
    return ", ".join(items[:-1]) + " and " + items[-1] if len(items) > 1 else "".join(items)
