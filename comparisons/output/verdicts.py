"""Verdicts in words: the command that computes a case again, sentences and lines on gates, the files of a folder."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path

import pandas as pd

from comparisons.data.file_names import GATES, JUNIT, SUMMARY, VERDICTS
from comparisons.judging.decision import Verdict
from comparisons.judging.gates import Gate
from comparisons.judging.report_card import ModelCheck
from comparisons.judging.summary import coverage_text, summarise
from comparisons.numerics.number_text import error_text, exact, limits_text
from comparisons.output.junit import junit
from comparisons.output.latex import latex
from comparisons.output.markup import markdown
from comparisons.output.table import Column, Record, laid_out
from comparisons.problem import PARAMETERS
from comparisons.problem.problem import split_name
from comparisons.problem.variation import with_unit
from comparisons.quantities import CURVES
from comparisons.runs.atomic_files import write_file
from comparisons.runs.csv_format import write_table

#: Names of gates that are listed in one sentence.
_NAMES = 12

#: What became of gates, for a reader of a page: as expected, and not.
_EXPECTED = (
    (Verdict.PASS, "within the limits"),
    (Verdict.XFAIL, "with a deviation that was stated in advance"),
    (Verdict.NOT_APPLICABLE, "without a case"),
)
_SURPRISING = (
    (Verdict.ERROR, "could not be judged"),
    (Verdict.FAIL, "outside the limits"),
    (Verdict.XPASS, "without the deviation that was stated in advance"),
    (Verdict.INCONCLUSIVE, "undecided, because the bounds are too large"),
)

#: What is stored of each gate beside its verdicts: what was required, in which unit, and on what grounds.
GATE_COLUMNS = ("id", "requirement", "metric", "basis", "grounds")


def command(row: Record, specs: Mapping[str, str]) -> str:
    """Return the command that computes the candidate's side of a verdict again; nothing for that of a whole gate.

    Parameters
    ----------
    row : mapping or Series
        A row of verdicts.
    specs : mapping of str to str
        The SPEC that finds each external model: its name alone does not.

    Examples
    --------
    >>> case = {"n": 2, "k": 0, "mu": 5, "nu": None}
    >>> command(pd.Series({"candidate": "jkr", "quantity": "pull_off_force", **case}), {})
    'fscm-bench solve --model jkr --quantity pull_off_force --n 2 --k 0 --mu 5'
    """
    model = specs.get(row["candidate"], row["candidate"])
    varied: list[str] = []
    if row.get("problem"):
        file, *varied = split_name(row["problem"])
        case = ["--problem", file]
    else:
        case = [word for name in PARAMETERS if pd.notna(row[name]) for word in (f"--{name}", exact(row[name]))]
    if not case:
        return ""
    verb = "curve" if row["quantity"] in CURVES else "sweep" if varied else "solve"
    vary = [word for text in varied for word in ("--vary", with_unit(text))] if verb == "sweep" else []
    return shlex.join(["fscm-bench", verb, "--model", model, "--quantity", row["quantity"], *case, *vary])


def gates_sentence(gates: pd.DataFrame, verdicts: pd.DataFrame, checks: Iterable[ModelCheck] = ()) -> str:
    """Return how many gates pass, fail where that is known, and do neither, what report cards say, and the cases.

    Parameters
    ----------
    gates : DataFrame
        One row for each gate and candidate, as of `comparisons.judging.summary.summarise`.
    verdicts : DataFrame
        As of `comparisons.judging.judge.judge`.
    checks : iterable of ModelCheck
        Of the report cards.

    Examples
    --------
    >>> gates = pd.DataFrame({"gate": ["A", "B", "C"], "verdict": ["PASS", "XFAIL", "FAIL"]})
    >>> gates_sentence(gates, gates)  # doctest: +ELLIPSIS
    '1 of 3 gates pass, 1 fail where the model is known to be wrong, 1 unexpected: 1 FAIL (cases: 1 FAIL, ...)'
    >>> gates_sentence(gates[:0], gates[:0], [ModelCheck("mine", "digits", Verdict.INCONCLUSIVE, "copied")])
    'No gate was evaluated; report cards: 1 INCONCLUSIVE'
    """
    cards = verdict_counts(check.verdict for check in checks if check.verdict is not Verdict.PASS)
    ending = f"; report cards: {cards}" if cards else ""
    if gates.empty:
        return f"No gate was evaluated{ending}"
    count, surprising = Counter(gates["verdict"]), unexpected(gates)
    parts = [f"{count[Verdict.PASS]} of {len(gates)} gates pass"]
    parts.append(f"{count[Verdict.XFAIL]} fail where the model is known to be wrong")
    if count[Verdict.NOT_APPLICABLE]:
        parts.append(f"{count[Verdict.NOT_APPLICABLE]} apply to no case")
    parts.append(": ".join(filter(None, [f"{len(surprising)} unexpected", verdict_counts(surprising["verdict"])])))
    return f"{', '.join(parts)} (cases: {verdict_counts(verdicts['verdict'])}){ending}"


def checks_sentence(gates: pd.DataFrame, checks: Iterable[ModelCheck] = ()) -> str:
    """Return for a reader of a page whether the gates came out as expected, and how many of them how.

    Parameters
    ----------
    gates : DataFrame
        As of `gates_sentence`.
    checks : iterable of ModelCheck
        Of the report cards.

    Examples
    --------
    >>> gates = pd.DataFrame({"gate": ["A", "B", "C"], "verdict": ["PASS", "XFAIL", "FAIL"]})
    >>> checks_sentence(gates[:2])
    'All 2 gates came out as expected: 1 within the limits, 1 with a deviation that was stated in advance.'
    >>> checks_sentence(gates[2:])
    '1 of 1 gates did not come out as expected: 1 outside the limits.'
    """
    ending = [
        f"{len(rest)} of the report cards" for rest in [[c for c in checks if c.verdict is not Verdict.PASS]] if rest
    ]
    remarks = f" To be looked at: {ending[0]}." if ending else ""
    if gates.empty:
        return f"No gate was evaluated.{remarks}"
    count, surprising = Counter(gates["verdict"]), unexpected(gates)
    expected, others = ([f"{count[v]} {text}" for v, text in words if count[v]] for words in (_EXPECTED, _SURPRISING))
    if surprising.empty:
        return f"All {len(gates)} gates came out as expected: {', '.join(expected)}.{remarks}"
    head = f"{len(surprising)} of {len(gates)} gates did not come out as expected: {', '.join(others)}"
    return f"{'; '.join([head, *filter(None, [', '.join(expected)])])}.{remarks}"


def verdict_counts(verdicts: Iterable[str]) -> str:
    """Return how many there are of each verdict, worst first."""
    count = Counter(verdicts)
    return ", ".join(f"{count[verdict]} {verdict}" for verdict in Verdict if count[verdict])


def unexpected(gates: pd.DataFrame) -> pd.DataFrame:
    """Return the gates of a summary that do not behave as declared, worst first."""
    return gates[~gates["verdict"].isin([Verdict.PASS, Verdict.XFAIL, Verdict.NOT_APPLICABLE])]


def gate_lines(gates: pd.DataFrame, specs: Mapping[str, str], most: int | None = None) -> list[str]:
    """Return for each gate its verdict, the error of the worst case, and the command that computes that case again.

    Parameters
    ----------
    gates : DataFrame
        As of `comparisons.judging.summary.summarise`.
    specs : mapping of str to str
        The SPEC that finds each external model.
    most : int, optional
        Gates that are shown; the last line counts the others.
    """
    lines: list[str] = []
    for row in gates.head(most or len(gates)).to_dict("records"):
        error = error_text(row["error"], row["uncertainty"])
        against = f" against {row['reference']}" if row["reference"] else ""
        stated = f": E = {error}, limits {limits_text(row['lower'], row['upper'])}" if error else ""
        covered = f", a value in {text}" if (text := coverage_text(row)) else ""
        lines.append(f"{row['verdict']} {row['gate']} of {row['candidate']}{against}{stated}{covered}")
        lines += [f"  {text}" for text in (row["reason"], command(row, specs)) if text]
    if most and len(gates) > most:
        lines.append(f"{len(gates) - most} more do not pass; --verbose prints all")
    return lines


def declared_sentence(gates: pd.DataFrame) -> str:
    """Return the names of the gates that fail where that is known, the first ones and the number of the others.

    Examples
    --------
    >>> declared_sentence(pd.DataFrame({"gate": ["A", "B"], "verdict": ["PASS", "XFAIL"]}))
    'known to be wrong (XFAIL; --verbose prints the commands): B'
    """
    names = list(dict.fromkeys(gates.loc[gates["verdict"] == Verdict.XFAIL, "gate"]))
    more = f" and {len(names) - _NAMES} more" if len(names) > _NAMES else ""
    return (
        f"known to be wrong (XFAIL; --verbose prints the commands): {', '.join(names[:_NAMES])}{more}" if names else ""
    )


def write_verdicts(
    folder: Path, judged: pd.DataFrame, checks: Sequence[ModelCheck], gates: list[Gate], specs: Mapping[str, str]
) -> None:
    """Write the verdicts as CSV, Markdown, LaTeX and JUnit XML.

    The summary by gate, and what the gates required, go beside them as CSV: a gates file may change later.
    """
    summary = summarise(judged)
    required = [[str(getattr(gate, name)) for name in GATE_COLUMNS] for gate in gates]
    write_table(judged.assign(verdict=judged["verdict"].map(str)), folder / VERDICTS)
    write_table(summary.assign(verdict=summary["verdict"].map(str)), folder / SUMMARY)
    write_table(pd.DataFrame(required, columns=list(GATE_COLUMNS), dtype=str), folder / GATES)
    again, requirement = partial(command, specs=specs), {gate.id: gate.requirement for gate in gates}
    requirements = Column("requirement", lambda row: requirement.get(row["gate"], ""))
    by_gate = laid_out("by_gate", summary, Column("command", again), requirements)
    worst = laid_out("worst_of_gates", summary, id="verdicts")
    write_file(folder / JUNIT, junit(judged, checks, again))
    write_file(folder / f"{VERDICTS}.md", markdown(by_gate.texts, by_gate.caption))
    write_file(folder / f"{VERDICTS}.tex", latex(worst.texts, worst.caption, worst.id))
