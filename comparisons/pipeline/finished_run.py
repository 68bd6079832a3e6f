"""Finished run: its tables, pictures, verdicts and record in its folder."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from comparisons.data.contained_paths import path_inside
from comparisons.data.file_names import COMPARISON_FILES, GATES_TEXT, GRID_TEXT, INPUTS, RUN_FILES, is_of_verdicts
from comparisons.data.input_files import LARGEST_TABLE, read_bytes
from comparisons.judging.decision import Verdict
from comparisons.pipeline.inputs import Cases, Gates, RunInputs, names_of_inputs
from comparisons.pipeline.judgement import Judgement, judge_and_write
from comparisons.pipeline.report_cards import make_cards
from comparisons.pipeline.tables import RunTables, make_tables, write_pictures, write_tables
from comparisons.registry import ExternalIdentity, create
from comparisons.runs.atomic_files import atomic
from comparisons.runs.computation import Completed
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import read_record, record_content, write_record
from comparisons.runs.rows import Row

__all__ = ["FinishedRun", "described", "kept_texts", "write_run"]


@dataclass(frozen=True, slots=True)
class FinishedRun:
    """A finished run.

    Attributes
    ----------
    folder : Path
        With the files of the run.
    tables : RunTables
    counts : dict of str to int
        Numbers of rows: all, resumed, and by status.
    failures : tuple of Row
        The rows of computations that failed.
    judgement : Judgement or None
        None if there were no gates.
    """

    folder: Path
    tables: RunTables
    counts: dict[str, int]
    failures: tuple[Row, ...]
    judgement: Judgement | None

    @property
    def verdict(self) -> Verdict | None:
        """The verdict over all gates; None if there were no gates."""
        return self.judgement.verdict if self.judgement else None


def write_run(
    target: RunFolder, inputs: RunInputs, completed: Completed, arguments: Mapping[str, Any], started: str
) -> FinishedRun:
    """Write what follows from the rows of a run into its folder: tables, pictures, verdicts and the record.

    Parameters
    ----------
    target : RunFolder
    inputs : RunInputs
    completed : Completed
        The rows.
    arguments : mapping
        How they were computed, as the record holds it beside the inputs.
    started : str
        When the command began.
    """
    chosen, rules, chosen_models, external = inputs.cases, inputs.gates, inputs.models, inputs.external
    texts = kept_texts(target, chosen, rules)
    rows = completed.rows
    tables = make_tables(rows, chosen, chosen_models)
    write_tables(tables, target)
    if chosen.tier is not None:
        write_pictures(tables, target)
    for path, kept in texts.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        with atomic(path) as file:
            file.write(kept)
    specs = {name: model.spec for name, model in external.items()}
    judgement: Judgement | None = None
    cards: dict[str, Any] = {}
    if rules is not None:
        cards = make_cards(external, rows, completed.parts, {task.key: task.problem for task in inputs.plan()})
        judgement = judge_and_write(target, inputs, tables.results, tables.curves, cards)
    stale = {GRID_TEXT} if rules is not None else {GATES_TEXT}
    _remove_stale(target, {*stale, *COMPARISON_FILES}, texts, judged=rules is not None)
    counts = {"all": len(rows), "resumed": completed.resumed, **Counter(row.status for row in rows)}
    seconds: Counter[str] = Counter()
    for row in rows:
        seconds[row.model] += row.seconds  # type: ignore[assignment]
    content = record_content(
        "sweep" if rules is None else "run",
        {
            "tier": chosen.tier,
            "grid": chosen.source,
            "model": chosen_models,
            "external": specs,
            "gates": None if rules is None else rules.source,
            **arguments,
            "out": str(target.path),
        },
        started=started,
        parts=completed.parts,
        rows=counts,
        seconds=dict(sorted(seconds.items())),
        verdicts=judgement.counts if judgement else {},
    )
    content |= {
        "cases_sha256": chosen.sha256,
        "models": described({task.model for task in inputs.plan()}, external),
        "domains": {name: domain.as_json() for name, domain in inputs.domains.items()},
    }
    others = {
        "gates_sha256": rules and rules.sha256,
        "evaluated_again": completed.evaluated_again,
        "cards": cards,
        "fresh": inputs.fresh and inputs.fresh.as_json(),
        "coverage": judgement and judgement.coverage,
    }
    content |= {name: value for name, value in others.items() if value or (name == "coverage" and value is not None)}
    write_record(content, target.record, [*RUN_FILES, *names_of_inputs(chosen)])
    failures = tuple(row for row in rows if row.status == "failed")
    return FinishedRun(target.path, tables, counts, failures, judgement)


def kept_texts(folder: RunFolder, cases: Cases, gates: Gates | None) -> dict[Path, bytes]:
    """Return what the run keeps of its inputs; refuse to replace files that are not of a run."""
    texts = {} if gates is None else {folder.gates_text: gates.text.encode()}
    if cases.tier is None:
        texts[folder.grid_text] = cases.text.encode()
        texts |= {path_inside(folder.path, f"{INPUTS}/{name}"): content for name, content in cases.files.items()}
    for path, content in texts.items():
        if path.exists() and not folder.store.exists() and read_bytes(path, LARGEST_TABLE) != content:
            raise ValueError(
                f"{path} was not written by a run, and a run would replace it; choose another folder with --out"
            )
    return texts


def _remove_stale(folder: RunFolder, names: Collection[str], kept: Collection[Path], *, judged: bool) -> None:
    """Remove files that an earlier run of the folder has written and that this one does not have."""
    try:
        written = read_record(folder.record)["files"]
    except ValueError:
        return
    for name in written:
        path = path_inside(folder.path, name)
        stale = name in names or name.startswith(f"{INPUTS}/") or (is_of_verdicts(name) and not judged)
        if stale and path not in kept:
            path.unlink(missing_ok=True)


def described(names: set[str], external: Mapping[str, ExternalIdentity]) -> dict[str, dict[str, str]]:
    """Return version, citation and domain of each model, and which files the version of an external one covers."""
    models = {name: external.get(name) or create(name) for name in sorted(names)}
    described = {
        name: {"version": model.version, "citation": model.citation, "domain": model.domain}
        for name, model in models.items()
    }
    for name, model in external.items():
        if model.hashed:
            described[name]["hashed"] = model.hashed
    return described
