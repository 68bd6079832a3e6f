"""Judgement of the results in a folder, when they are computed and again later."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.console.progress import log, note
from comparisons.data.file_names import CURVES, GATES_TEXT, INPUTS, RECORD, RESULTS
from comparisons.judging.decision import Verdict
from comparisons.judging.fresh_cases import FreshCases
from comparisons.judging.fresh_verdicts import compare_with_standing, judge_undrawn
from comparisons.judging.judge import every_verdict, judge
from comparisons.judging.report_card import ModelCheck, check_models, overall
from comparisons.judging.selection import relevant
from comparisons.judging.summary import COVERAGE, summarise
from comparisons.output.verdicts import write_verdicts
from comparisons.pipeline.inputs import RunInputs, read_gates, stored_inputs
from comparisons.runs.atomic_files import write_file
from comparisons.runs.csv_format import read_table
from comparisons.runs.environment import fingerprint
from comparisons.runs.folder_lock import locked
from comparisons.runs.record import check_files, read_record, warn_of_other_code, write_record


@dataclass(frozen=True, slots=True)
class Judgement:
    """Verdicts on the results in a folder.

    Attributes
    ----------
    folder : Path
    inputs : RunInputs
        What was computed, and the gates.
    verdicts : DataFrame
        One row for each gate and case, as of `comparisons.judging.judge.judge`.
    cards : mapping
        The report cards of the external models.
    """

    folder: Path
    inputs: RunInputs
    verdicts: pd.DataFrame
    cards: Mapping[str, Any]

    @property
    def checks(self) -> list[ModelCheck]:
        """The verdicts of the report cards."""
        return check_models(self.verdicts, self.cards)

    @property
    def verdict(self) -> Verdict:
        """The verdict over all gates and report cards; ERROR if no gate was evaluated."""
        return overall(self.verdicts, self.checks)

    def as_json(self) -> dict[str, Any]:
        """Return what the record of a run holds: how many cases have each verdict, and the coverage of each gate."""
        rows = summarise(self.verdicts).to_dict("records")
        coverage = [
            {"gate": row["gate"], "candidate": row["candidate"], "verdict": str(row["verdict"])}
            | {name: int(row[name]) for name in COVERAGE}
            for row in rows
        ]
        counts = Counter(map(str, self.verdicts["verdict"]))
        return {"verdicts": {"all": str(self.verdict), **counts}, "coverage": coverage}


def judge_and_write(
    folder: Path, inputs: RunInputs, results: pd.DataFrame, curves: pd.DataFrame, cards: Mapping[str, Any]
) -> Judgement:
    """Judge results and report cards, and write the verdicts and their summary beside them."""
    if inputs.gates is None:
        raise ValueError(f"{folder} has no gates to be judged by")
    gates, grids, fresh = inputs.gates.gates, inputs.cases.grids, inputs.fresh.parts if inputs.fresh else ()
    standing = judge(gates, grids, results, curves, inputs.models, inputs.taken)
    tables = [standing]
    if fresh:
        drawn = every_verdict(judge([part.gate], [part.grid], results, None, None, inputs.taken) for part in fresh)
        tables += [drawn, compare_with_standing(standing, drawn)]
    if inputs.fresh:
        tables.append(judge_undrawn(inputs.fresh.undrawn))
    judgement = Judgement(folder, inputs, every_verdict(tables), cards)
    written = [*gates, *{part.gate.id: part.gate for part in fresh}.values()]
    write_verdicts(folder, judgement.verdicts, judgement.checks, written, inputs.specs)
    return judgement


def judge_folder(folder: str | Path, gates: str | Path | None = None) -> Judgement:
    """Judge the stored results of a run again, without any computation.

    Parameters
    ----------
    folder : str or Path
        Of a finished run or sweep.
    gates : str or Path, optional
        A gates file in place of the gates of the run.  A sweep has no gates of its own, and becomes a run.

    Raises
    ------
    ValueError
        If there is no finished run, a file of it was changed, the gates cannot be used, or another process has the
        folder; one sentence says which.
    """
    folder = Path(folder)
    # Nothing is written, not even the lock, where there is no finished run.
    read_record(folder / RECORD)
    with locked(folder):
        return _judged_again(folder, None if gates is None else Path(gates))


def _judged_again(folder: Path, gates: Path | None) -> Judgement:
    record = read_record(folder / RECORD)
    name, arguments = record["command_name"], record["arguments"]
    if name == "paper":
        raise ValueError(f"{folder} holds figures of the paper, which no gate judges: give the folder of a run")
    if name == "sweep" and gates is None:
        raise ValueError(f"{folder} is the folder of a sweep, which has no gates: give some with --gates FILE")
    check_files(record, folder, written_again=True)
    other_code = warn_of_other_code(record, folder)
    inputs = _inputs_with_gates(folder, record, gates)
    results, curves = (read_table(folder / f"{table}.csv") for table in (RESULTS, CURVES))
    if inputs.cases.sha256 != record["cases_sha256"]:
        log(f"the cases have changed since {folder} was computed; it is judged by the present cases")
    assert inputs.gates is not None
    label, checksum = inputs.gates.source or "the standing gates", inputs.gates.sha256
    if name == "sweep":
        write_file(folder / GATES_TEXT, inputs.gates.text)
        arguments["gates"] = label
        record |= {"command_name": "run", "gates_sha256": checksum}
    same_gates = checksum == record.get("gates_sha256")
    note(f"judged by {label}, which are {'' if same_gates else 'not '}the gates of the run {folder}")
    judgement = judge_and_write(folder, inputs, results, curves, record.get("cards", {}))
    # The record has the verdicts that are beside it, and the gates that they are by.
    record = {name: value for name, value in record.items() if not name.startswith("judged_")} | judgement.as_json()
    if other_code:
        record["judged_by_other_code"] = fingerprint()
    if not same_gates:
        record["judged_again"] = {"gates": label, "gates_sha256": checksum}
    write_record(record, folder / RECORD)
    return judgement


def _inputs_with_gates(folder: Path, record: Mapping[str, Any], gates: Path | None) -> RunInputs:
    """Return what a record has computed, with a file of gates, or the copy of those of the run."""
    inputs = stored_inputs(folder, record)
    copy = folder / GATES_TEXT
    source = gates or (copy if copy.exists() else None)
    # A run with the standing gates keeps a copy of them, most of which are about models that it does not compute.
    standing = gates is None and record["arguments"]["gates"] is None
    loaded = read_gates(source, inputs.cases, inputs.models, standing=standing)
    fresh = None
    if "fresh" in record:
        judged = relevant(loaded.gates, inputs.cases.grids, inputs.models)
        fresh = FreshCases.of_json(record["fresh"], judged, folder / INPUTS)
    loaded = replace(loaded, source=None if source is None else str(source))
    return replace(inputs, gates=loaded, fresh=fresh)
