"""Judgement of the results in a folder, when they are computed and again later."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from shlex import quote
from typing import Any

import pandas as pd

from comparisons.console.progress import log, note
from comparisons.data.file_names import RUN_FILES
from comparisons.domain import Domain
from comparisons.judging.card_gates import card_gates, every_verdict, judge_cards, judge_digits, overall
from comparisons.judging.decision import Verdict
from comparisons.judging.fresh_cases import FreshCases
from comparisons.judging.fresh_verdicts import compare_with_standing, judge_undrawn
from comparisons.judging.judge import judge
from comparisons.judging.selection import relevant
from comparisons.judging.summary import COVERAGE, summarise
from comparisons.output.junit import evaluation_seconds
from comparisons.output.verdicts import write_verdicts
from comparisons.pipeline.inputs import RunInputs, domains_in, names_of_inputs, read_gates, stored_cases
from comparisons.problem import PARAMETERS
from comparisons.registry import ExternalIdentity
from comparisons.runs.atomic_files import atomic
from comparisons.runs.case_columns import keys_in
from comparisons.runs.environment import fingerprint
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import check_files, read_record, warn_of_other_code, write_record
from comparisons.runs.rows import Key
from comparisons.runs.tables import read_table
from comparisons.runs.tasks import plan

__all__ = ["Judgement", "judge_and_write", "judge_folder"]


@dataclass(frozen=True, slots=True)
class Judgement:
    """Verdicts on the results in a folder.

    Attributes
    ----------
    folder : Path
    verdicts : DataFrame
        One row for each gate and case, as of `comparisons.judging.judge.judge`.
    specs : mapping of str to str
        Name of each external model -> the SPEC that finds it.
    markdown : str
        The table of gates, for the summary page of a job.
    cards : mapping
        The report cards of the external models.
    domains : mapping of str to Domain
        The domains that models declare.
    models : list of str or None
        The given models.
    """

    folder: Path
    verdicts: pd.DataFrame
    specs: Mapping[str, str]
    markdown: str
    cards: Mapping[str, Any] = field(default_factory=dict)
    domains: Mapping[str, Domain] = field(default_factory=dict)
    models: Sequence[str] | None = None

    @property
    def verdict(self) -> Verdict:
        """The verdict over all gates; ERROR if no gate of the user was evaluated."""
        return overall(self.verdicts)

    @property
    def counts(self) -> dict[str, str | int]:
        """The verdict over all and how many cases have each, as the record of a run holds them."""
        return {"all": str(self.verdict), **Counter(map(str, self.verdicts["verdict"]))}

    @property
    def coverage(self) -> list[dict[str, Any]]:
        """Verdict and coverage of each gate and candidate, as the record of a run holds them."""
        summary = summarise(self.verdicts)
        return [
            {"gate": row["gate"], "candidate": row["candidate"], "verdict": str(row["verdict"])}
            | {name: int(row[name]) for name in COVERAGE}
            for row in summary.to_dict("records")
        ]


def judge_and_write(
    folder: RunFolder, inputs: RunInputs, results: pd.DataFrame, curves: pd.DataFrame, cards: Mapping[str, Any]
) -> Judgement:
    """Judge results and report cards, and write the verdicts and their summary beside them."""
    if inputs.gates is None:
        raise ValueError(f"{folder.path} has no gates to be judged by")
    gates, grids, fresh = inputs.gates.gates, inputs.cases.grids, inputs.fresh.parts if inputs.fresh else ()
    standing_keys = {task.key for task in plan(grids, inputs.models)}
    fresh_keys = {task.key for task in plan([part.grid for part in fresh])}
    standing = judge(gates, grids, results, curves, inputs.models, inputs.domains, fresh_keys)
    tables = [standing]
    if fresh:
        every = standing_keys | fresh_keys
        drawn = every_verdict(
            judge([part.gate], [part.grid], results, curves, None, inputs.domains, every) for part in fresh
        )
        tables += [drawn, compare_with_standing(standing, drawn)]
    if inputs.fresh:
        tables.append(judge_undrawn(inputs.fresh.undrawn))
    of_gates = every_verdict(tables)
    of_cards = every_verdict([judge_cards(cards), judge_digits(of_gates, cards)])
    verdicts = every_verdict([of_gates, of_cards])
    specs = {name: model.spec for name, model in inputs.external.items()}
    written = [*gates, *{part.gate.id: part.gate for part in fresh}.values(), *card_gates(of_cards)]
    markdown = write_verdicts(folder.path, verdicts, written, specs, evaluation_seconds(results, curves))
    return Judgement(folder.path, verdicts, specs, markdown, cards, inputs.domains, inputs.models)


def judge_folder(folder: Path, gates: Path | None = None) -> Judgement:
    """Judge the stored results of a run again, without any computation.

    Parameters
    ----------
    folder : Path
        Of a finished run or sweep.
    gates : Path, optional
        A gates file in place of the gates of the run.  A sweep has no gates of its own, and becomes a run.

    Raises
    ------
    ValueError
        If there is no finished run, a file of it was changed, or the gates cannot be used; one sentence says which.
    """
    stored = RunFolder(folder)
    record = read_record(stored.record)
    name, arguments = record["command_name"], record["arguments"]
    if name == "paper":
        raise ValueError(f"{folder} holds figures of the paper, which no gate judges: give the folder of a run")
    if name == "sweep" and gates is None:
        raise ValueError(f"{folder} is the folder of a sweep, which has no gates: give some with --gates FILE")
    check_files(record, folder, written_again=True)
    other_code = warn_of_other_code(record, folder)
    models, specs = arguments["model"], arguments["external"]
    cases = stored_cases(stored, arguments["tier"], models)
    source = gates or (stored.gates_text if stored.gates_text.exists() else None)
    # A run with the standing gates keeps a copy of them, most of which are about models that it does not compute.
    standing = gates is None and arguments["gates"] is None
    chosen = read_gates(source, cases, models, standing=standing)
    results, curves = (read_table(stored.parquet(stem)) for stem in (stored.results, stored.curves))
    if cases.sha256 != record["cases_sha256"]:
        log(f"the cases have changed since {folder} was computed; it is judged by the present cases")
    label = "the standing gates" if source is None else str(source)
    own = chosen.sha256 == record.get("gates_sha256")
    note(
        f"judged by {label}, "
        + ("which are the gates of the run" if own else f"which are not the gates of the run {folder}")
    )
    if name == "sweep":
        with atomic(stored.gates_text) as file:
            file.write(chosen.text.encode())
        record["command_name"], record["gates_sha256"] = "run", chosen.sha256
        arguments["gates"], own = label, True
    # Only their SPECs are needed: nothing is computed.
    external = {name: ExternalIdentity(name, "", spec, citation="", domain="") for name, spec in specs.items()}
    domains = domains_in(record)
    fresh = (
        FreshCases.of_json(record["fresh"], relevant(chosen.gates, cases.grids, models), stored.inputs)
        if "fresh" in record
        else None
    )
    inputs = RunInputs(cases, chosen, models, external, domains, fresh)
    _warn_of_missing(inputs, results, curves, folder)
    judgement = judge_and_write(stored, inputs, results, curves, record.get("cards", {}))
    record["coverage"] = judgement.coverage
    # The record has the verdicts that are beside it, and the gates that they are by.
    record["verdicts"] = judgement.counts
    record.pop("judged_again", None)
    record.pop("judged_by_other_code", None)
    if other_code:
        record["judged_by_other_code"] = fingerprint()
    if not own:
        record["judged_again"] = {"gates": label, "gates_sha256": chosen.sha256}
    write_record(record, stored.record, [*RUN_FILES, *names_of_inputs(cases)])
    return judgement


def _warn_of_missing(inputs: RunInputs, results: pd.DataFrame, curves: pd.DataFrame, folder: Path) -> None:
    """Write in one sentence how many results the gates need that the run, which had other gates, did not compute."""
    if not all({"model", "quantity", *PARAMETERS, "status"} <= set(table.columns) for table in (results, curves)):
        return  # The judge refuses them.
    statuses: dict[Key, str] = {
        key: status for table in (results, curves) for key, status in zip(keys_in(table), table["status"], strict=True)
    }
    missing = inputs.needed(statuses) - statuses.keys()
    if missing:
        log(
            f"{len(missing)} results that these gates need are not in {folder}, which has those of its own gates: "
            f"fscm-bench run with --out {quote(str(folder))} and these gates computes them"
        )
