"""Judgement of the results in a folder, when they are computed and again later."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from comparisons.console.progress import log
from comparisons.data.file_names import VERDICT_FILES
from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.judge import judge
from comparisons.judging.selection import needed_keys
from comparisons.output.junit import evaluation_seconds
from comparisons.output.verdicts import write_verdicts
from comparisons.pipeline.inputs import Cases, Gates, load_cases, read_gates
from comparisons.runs.atomic_files import atomic
from comparisons.runs.environment import fingerprint
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import check_files, read_record, warn_of_other_code, write_record
from comparisons.runs.rows import Key
from comparisons.runs.tables import read_table

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
    """

    folder: Path
    verdicts: pd.DataFrame
    specs: Mapping[str, str]
    markdown: str

    @property
    def verdict(self) -> Verdict:
        """The verdict over all gates."""
        return roll_up(self.verdicts["verdict"])

    @property
    def counts(self) -> dict[str, str | int]:
        """The verdict over all and how many cases have each, as the record of a run holds them."""
        return {"all": str(self.verdict), **Counter(map(str, self.verdicts["verdict"]))}


def judge_and_write(
    folder: RunFolder,
    gates: Gates,
    cases: Cases,
    results: pd.DataFrame,
    curves: pd.DataFrame,
    models: list[str] | None,
    specs: Mapping[str, str],
) -> Judgement:
    """Judge results and write the verdicts and their summary beside them."""
    verdicts = judge(gates.gates, cases.grids, results, curves, models)
    markdown = write_verdicts(folder.path, verdicts, gates.gates, specs, evaluation_seconds(results, curves))
    return Judgement(folder.path, verdicts, specs, markdown)


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
    check_files(record, folder, written_again=VERDICT_FILES)
    other_code = warn_of_other_code(record, folder)
    models, specs = arguments["model"], arguments["external"]
    cases = load_cases(arguments["tier"] or stored.grid_text, models)
    source = gates or (stored.gates_text if stored.gates_text.exists() else None)
    # A run with the standing gates keeps a copy of them, most of which are about models that it does not compute.
    standing = gates is None and arguments["gates"] is None
    chosen = read_gates(source, cases, models, standing=standing)
    results, curves = (read_table(stored.parquet(stem)) for stem in (stored.results, stored.curves))
    if cases.sha256 != record["cases_sha256"]:
        log(f"the cases have changed since {folder} was computed; it is judged by the present cases")
    label = "the standing gates" if source is None else str(source)
    own = chosen.sha256 == record.get("gates_sha256")
    log(
        f"judged by {label}, "
        + ("which are the gates of the run" if own else f"which are not the gates of the run {folder}")
    )
    if name == "sweep":
        with atomic(stored.gates_text) as file:
            file.write(chosen.text.encode())
        record["command_name"], record["gates_sha256"] = "run", chosen.sha256
        arguments["gates"], own = label, True
    _warn_of_missing(chosen, cases, models, results, curves, folder)
    judgement = judge_and_write(stored, chosen, cases, results, curves, models, specs)
    # The record has the verdicts that are beside it, and the gates that they are by.
    record["verdicts"] = judgement.counts
    record.pop("judged_again", None)
    record.pop("judged_by_other_code", None)
    if other_code:
        record["judged_by_other_code"] = fingerprint()
    if not own:
        record["judged_again"] = {"gates": label, "gates_sha256": chosen.sha256}
    write_record(record, stored.record)
    return judgement


def _warn_of_missing(
    gates: Gates,
    cases: Cases,
    models: list[str] | None,
    results: pd.DataFrame,
    curves: pd.DataFrame,
    folder: Path,
) -> None:
    """Write in one sentence how many results the gates need that the run, which had other gates, did not compute."""
    key = ["model", "quantity", "n", "k", "mu", "nu"]
    if not all({*key, "status"} <= set(table.columns) for table in (results, curves)):
        return  # The judge refuses them.
    statuses: dict[Key, str] = {
        (*row[:5], None if pd.isna(row[5]) else row[5]): row[6]
        for table in (results, curves)
        for row in table[[*key, "status"]].itertuples(index=False, name=None)
    }
    missing = needed_keys(gates.gates, cases.grids, models, statuses) - statuses.keys()
    if missing:
        log(
            f"{len(missing)} results that these gates need are not in {folder}, which has those of its own gates: "
            f"fscm-bench run with --out {folder} and these gates computes them"
        )
