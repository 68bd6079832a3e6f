"""Finished run: its tables, pictures, verdicts and record in its folder."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from comparisons.data.contained_paths import path_inside
from comparisons.data.file_names import COMPARISON_FILES, GATES_TEXT, GRID_TEXT, INPUTS, RECORD, STORE, is_of_verdicts
from comparisons.data.input_files import LARGEST_TABLE, read_bytes
from comparisons.judging.decision import Verdict
from comparisons.pipeline.inputs import Cases, Gates, RunInputs
from comparisons.pipeline.judgement import Judgement, judge_and_write
from comparisons.pipeline.report_cards import make_cards
from comparisons.pipeline.tables import RunTables, make_tables, write_picture_of_values, write_pictures, write_tables
from comparisons.registry import ExternalIdentity, create
from comparisons.runs.atomic_files import write_file
from comparisons.runs.computation import Completed
from comparisons.runs.record import read_record, record_content, write_record
from comparisons.runs.rows import Row


@dataclass(frozen=True, slots=True)
class FinishedRun:
    """A finished run.

    Attributes
    ----------
    folder : Path
        With the files of the run.
    inputs : RunInputs
    tables : RunTables
    counts : dict of str to int
        Numbers of rows: all, resumed, and by status.
    failures : tuple of Row
        The rows of computations that failed.
    judgement : Judgement or None
        None if there were no gates.
    """

    folder: Path
    inputs: RunInputs
    tables: RunTables
    counts: dict[str, int]
    failures: tuple[Row, ...]
    judgement: Judgement | None

    @property
    def verdict(self) -> Verdict | None:
        """The verdict over all gates; None if there were no gates."""
        return self.judgement.verdict if self.judgement else None


def write_run(
    folder: Path, inputs: RunInputs, completed: Completed, started: str, *, pdf: bool = False, **arguments: Any
) -> FinishedRun:
    """Write what follows from the rows of a run into its folder: tables, pictures, verdicts and the record.

    Parameters
    ----------
    folder : Path
    inputs : RunInputs
    completed : Completed
        The rows.
    started : str
        When the command began.
    pdf : bool
        Whether the pictures are written as PDF, too.
    **arguments
        How they were computed, as the record holds it beside the inputs; None for what was not given.
    """
    cases, gates, rows = inputs.cases, inputs.gates, completed.rows
    texts = kept_texts(folder, cases, gates)
    tables = make_tables(rows, cases, inputs.models)
    write_tables(tables, folder)
    if cases.tier is not None:
        write_pictures(tables, folder, pdf=pdf)
    else:
        write_picture_of_values(tables, folder)
    for path, content in texts.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        write_file(path, content)
    tasks = inputs.plan()
    entries: dict[str, Any] = {}
    judgement: Judgement | None = None
    if gates is not None:
        cards = make_cards(inputs.external, rows, completed.parts, {task.key: task.problem for task in tasks})
        judgement = judge_and_write(folder, inputs, tables.results, tables.curves, cards)
        entries = {"gates_sha256": gates.sha256, "cards": cards or None, **judgement.as_json()}
    _remove_stale(folder, texts, judged=judgement is not None)
    counts = {"all": len(rows), "resumed": completed.resumed, **Counter(row.status for row in rows)}
    models = sorted({row.model for row in rows})
    record = record_content(
        "sweep" if gates is None else "run",
        {
            "tier": cases.tier,
            "grid": cases.source,
            "model": inputs.models,
            "external": inputs.specs,
            "gates": None if gates is None else gates.source,
            **{name: value for name, value in arguments.items() if value is not None},
        },
        started=started,
        parts=completed.parts,
        seconds={name: sum(row.seconds for row in rows if row.model == name) for name in models},
        rows=counts,
        cases_sha256=cases.sha256,
        models=described({task.model for task in tasks}, inputs.external),
        domains={name: domain.as_json() for name, domain in inputs.domains.items()},
        evaluated_again=completed.evaluated_again,
        fresh=inputs.fresh and inputs.fresh.as_json(),
        **entries,
    )
    write_record(record, folder / RECORD)
    failures = tuple(row for row in rows if row.status == "failed")
    return FinishedRun(folder, inputs, tables, counts, failures, judgement)


def kept_texts(folder: Path, cases: Cases, gates: Gates | None) -> dict[Path, bytes]:
    """Return what the run keeps of its inputs; refuse to replace files that are not of a run."""
    texts = {} if gates is None else {folder / GATES_TEXT: gates.text.encode()}
    if cases.tier is None:
        texts[folder / GRID_TEXT] = cases.text.encode()
        texts |= {path_inside(folder, f"{INPUTS}/{name}"): content for name, content in cases.files.items()}
    for path, content in texts.items():
        if path.exists() and not (folder / STORE).exists() and read_bytes(path, LARGEST_TABLE) != content:
            raise ValueError(
                f"{path} was not written by a run, and a run would replace it; choose another folder with --out"
            )
    return texts


def _remove_stale(folder: Path, present: Collection[Path], *, judged: bool) -> None:
    """Remove files that an earlier run of the folder has written and that this one does not have."""
    try:
        written = read_record(folder / RECORD)["files"]
    except ValueError:
        return
    for name in written:
        path = path_inside(folder, name)
        is_input = name in (GATES_TEXT, GRID_TEXT) or name.startswith(f"{INPUTS}/")
        if (is_input and path not in present) or name in COMPARISON_FILES or (is_of_verdicts(name) and not judged):
            path.unlink(missing_ok=True)


def described(names: set[str], external: Mapping[str, ExternalIdentity]) -> dict[str, dict[str, str]]:
    """Return version, citation and domain of each model, and which files the version of an external one covers."""
    texts = {}
    for name in sorted(names):
        model = external.get(name) or create(name)
        texts[name] = {"version": model.version, "citation": model.citation, "domain": model.domain}
        if isinstance(model, ExternalIdentity) and model.hashed:
            texts[name]["hashed"] = model.hashed
    return texts
