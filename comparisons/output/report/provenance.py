"""Origin of the numbers of a page: command, code, machine, gates."""

from __future__ import annotations

from collections import Counter
from typing import Any

from comparisons.judging.card_gates import overall
from comparisons.judging.decision import Verdict
from comparisons.output.report.stored_run import Stored

__all__ = ["provenance", "record_facts", "verdict_counts"]


def verdict_counts(stored: Stored) -> list[tuple[str, int]]:
    """Return how many cases ended with each verdict, worst first."""
    found = Counter(stored.verdicts["verdict"])
    return [(str(verdict), found[verdict]) for verdict in Verdict if found[verdict]]


def provenance(stored: Stored) -> list[tuple[str, str]]:
    """Return the facts about the origin of the numbers, each with its name."""
    facts = record_facts(stored.record)
    then = stored.record["verdicts"]
    now = {"all": str(overall(stored.verdicts)), **dict(verdict_counts(stored))}
    if stored.judged and then != now:
        facts.append(("judged again", f"yes; at the end of the run the verdicts were {_pairs(then)}"))
    return facts


def record_facts(record: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the facts of a record (`run.json`), each with its name."""
    package, machine = record["package"], record["machine"]
    dirty = {True: "changed since that commit", False: "clean", None: "not known"}[package["dirty"]]
    facts = [
        ("command", " ".join(record["command"])),
        ("arguments", _pairs(record["arguments"])),
        ("started", record["started"]),
        ("finished", record["finished"]),
        ("seconds", f"{record['seconds']['run']:.4g}"),
        ("rows", _pairs(record["rows"])),
        ("package", f"{package['name']} {package['version']}"),
        ("commit", package["commit"] or "not known"),
        ("work tree", dirty),
        ("SHA-256 of the code", package["code_sha256"]),
        ("SHA-256 of the cases", record["cases_sha256"]),
        *([("SHA-256 of the gates", record["gates_sha256"])] if "gates_sha256" in record else []),
        ("Python", record["python"]),
        ("dependencies", _pairs(record["dependencies"])),
        ("system", machine["system"]),
        ("CPU", f"{machine['cpu']}, {machine['cores']} cores"),
        ("BLAS", "; ".join(f"{one['library']} {one['version']}, {one['threads']} threads" for one in record["blas"])),
    ]
    facts += [(f"part {number} of the computations", _pairs(part)) for number, part in enumerate(record["parts"], 1)]
    if "judged_by_other_code" in record:
        facts.append(("judged by other code", record["judged_by_other_code"]))
    if "judged_again" in record:
        again = record["judged_again"]
        facts.append(("judged again", f"by {again['gates']}, SHA-256 {again['gates_sha256']}"))
    return facts


def _pairs(content: dict[str, Any]) -> str:
    return ", ".join(f"{name} {_plain(value)}" for name, value in content.items() if value not in (None, {}, []))


def _plain(value: object) -> str:
    if isinstance(value, dict):
        return "(" + _pairs(value) + ")"
    return " ".join(map(str, value)) if isinstance(value, list) else str(value)
