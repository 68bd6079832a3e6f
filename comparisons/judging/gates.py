"""Gates: requirements on the models, read from a TOML file.

A gate compares one quantity of a candidate with that of a reference.  Types, names of keys and enumerations are
checked by the schema ``comparisons/data/gates.schema.json``, the rest by `comparisons.judging.gate_checks`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

from comparisons.data.input_files import read_text
from comparisons.data.toml_text import parse
from comparisons.data.validation import known_name, label, validated
from comparisons.judging.gate_checks import defects, has_parameters, in_si_units, plain_text
from comparisons.problem import Problem
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.registry import MODELS
from comparisons.runs.cases import TIERS, Grid

#: The candidate of a gate for every model that is named in a run.
GIVEN = "given"

#: How the error of a gate is measured: name of the metric -> its formula.
METRICS = {
    "rel": "(candidate - reference) / |reference|",
    "abs": "candidate - reference",
    "range-relative": "(candidate - reference) / range of the reference over the cases",
    "en": "(candidate - reference) / (u_candidate + u_reference), the normalised error E_n",
    "curve": "largest distance of the two curves, as a fraction of the picture",
}


@dataclass(frozen=True, slots=True)
class Gate:
    """A requirement that can be judged.

    Attributes
    ----------
    id : str
        Stable, to be cited.
    requirement : str
        One sentence.
    quantity : str
        A name of `QUANTITIES`, or of `CURVES` for the metric "curve".
    candidate, reference : str
        Names of models; the candidate `GIVEN` stands for every model named in a run.
    cases : dict
        Ranges [low, high] of n, k, mu and nu, ends included, tags of grids, and keys of a problem file as
        "solid.thickness", each with a range in SI or a word; what is not named is not restricted.
    metric : str
        One of `METRICS`.
    lower, upper : float
        Signed limits of the error; -inf or inf for none.
    max_reference_uncertainty : float
        Largest uncertainty of the reference, in the unit of the metric, with which the gate may pass; for "en"
        relative to the reference, or uncertainties without bound would pass.
    max_candidate_uncertainty : float or None
        The same of the candidate; "en" must state it, where the error counts in units of both uncertainties.
    basis : str
        Origin of the limits: "derived", "published" or "measured".
    grounds : str
        The derivation in short, the place in the paper, or the reason for the limits; in the file either this text or,
        as ``shared_grounds``, its name in the table ``[grounds]``.
    min_cases : int
        Fewer evaluated cases are an error.
    tier : str
        The first of `TIERS` that judges it.
    worst_measured : float or None
        For "measured", or with a `measured_range`: the error of largest size when the gate was made.
    measured_range : tuple of float or None
        (low, high) of the error E itself when the gate was made, with a margin.  An error outside has changed: a FAIL
        whatever its uncertainty, also of a gate that is declared to fail.
    reference_at : dict
        Parameters at which the reference is taken instead of those of the case, e.g. ``{k = 1}``.
    rival : str or None
        A second model: the error is then by how much the candidate's exceeds the rival's in size.
    not_applicable : str
        "error", or "leave-out" for a case to which a model does not apply.
    min_coverage : float or None
        A candidate that has a value in a smaller share of the cases in which it is evaluated fails.
    expected_failure : str or None
        Why every case is known to fail; one that passes is then reported.  It needs a `measured_range`, or every wrong
        value would be accepted as the known failure.
    """

    id: str
    requirement: str
    quantity: str
    candidate: str
    reference: str
    cases: Mapping[str, Any]
    metric: str
    lower: float
    upper: float
    max_reference_uncertainty: float
    basis: str
    grounds: str
    min_cases: int
    tier: str
    max_candidate_uncertainty: float | None = None
    worst_measured: float | None = None
    measured_range: tuple[float, float] | None = None
    reference_at: Mapping[str, float] = field(default_factory=dict)
    rival: str | None = None
    not_applicable: str = "error"
    min_coverage: float | None = None
    expected_failure: str | None = None

    @property
    def models(self) -> dict[str, str]:
        """Names of the candidate, the reference and, if there is one, the rival, by their roles.

        Examples
        --------
        >>> load_gates(gates_text())[0].models
        {'candidate': 'fem', 'reference': 'fscm'}
        """
        models = {"candidate": self.candidate, "reference": self.reference}
        return models if self.rival is None else {**models, "rival": self.rival}

    def selects(self, grid: Grid, case: Problem) -> bool:
        """Whether a case of a grid is one of the gate's; tags name grids, or properties of them.

        Examples
        --------
        >>> gate = load_gates(gates_text())[0]
        >>> gate.selects(Grid("a", "A", "quick", "b", (), (), ()), Problem.dimensionless(2, 0, 1))
        False
        """
        is_tagged = bool({grid.id, *grid.tags} & set(self.cases.get("tags", [grid.id])))
        has_reference = not self.reference_at or case["mu"] is not None
        return is_tagged and has_reference and has_parameters(case, self.cases)

    def reference_case(self, case: Problem) -> Problem:
        """Return the case in which the reference is taken."""
        return case.at(self.reference_at)


#: Entries that are sentences.
_TEXTS = ("requirement", "grounds", "expected_failure")


def load_gates(text: str, models: Iterable[str] = (), source: str = "the gates file") -> list[Gate]:
    """Read gates from TOML text.

    Parameters
    ----------
    text : str
        ``[[gate]]`` tables, and a table ``[grounds]`` of texts that several gates may share.
    models : iterable of str
        Names of models that a gate may name besides those of the registry.
    source : str
        What the text is of, for the sentence that refuses it.

    Raises
    ------
    ValueError
        If the text is not TOML, or a gate has a missing, unknown or inadmissible entry; the message names it.

    Examples
    --------
    >>> load_gates("[[gate]] # without anything")
    Traceback (most recent call last):
    ValueError: the gates file: gate 1: id, requirement, quantity, ... missing; a gate has ...
    """
    tables = parse(text, source)
    validated(tables, "gates", source)
    grounds = tables.get("grounds", {})
    shared = {name: plain_text(name, text, f"{source}: grounds") for name, text in grounds.items()}
    gates = [
        _gate(table, f"{source}: {label('gate', table, number)}", {*MODELS, *models}, shared)
        for number, table in enumerate(tables["gate"], start=1)
    ]
    ids = [gate.id for gate in gates]
    if repeated := sorted({id for id in ids if ids.count(id) > 1}):
        raise ValueError(f"{source}: the id of a gate must be unique; {', '.join(repeated)} is there twice")
    if unused := sorted(shared.keys() - {table.get("shared_grounds") for table in tables["gate"]}):
        raise ValueError(
            f"{source}: no gate has the shared grounds {', '.join(unused)}: remove them, or name them in one"
        )
    return gates


def _gate(table: dict[str, Any], where: str, models: set[str], shared: Mapping[str, str]) -> Gate:
    if ("shared_grounds" in table) == ("grounds" in table):
        raise ValueError(f"{where}: a gate needs either grounds, one sentence, or shared_grounds, a name in [grounds]")
    table = table | {"cases": in_si_units(table["cases"], where)}
    if name := table.pop("shared_grounds", None):
        known_name("shared grounds", name, shared, where)
        table["grounds"] = shared[name]
    if "measured_range" in table:
        table["measured_range"] = tuple(map(float, table["measured_range"]))
    gate = Gate(**table | {key: plain_text(key, table[key], where) for key in _TEXTS if key in table})
    for role, model in gate.models.items():
        if (role, model) != ("candidate", GIVEN):
            known_name(role, model, sorted(models), where)
    quantities = CURVES if gate.metric == "curve" else QUANTITIES
    known_name(f"quantity of the metric {gate.metric}", gate.quantity, quantities, where)
    try:
        gate.reference_case(Problem.dimensionless(2.0, 0.0, 1.0))
    except ValueError as refusal:
        raise ValueError(f"{where}: reference_at: {refusal}") from None
    if reasons := defects(gate):
        raise ValueError(f"{where}: {reasons[0]}")
    return gate


def gates_text(path: Path | None = None) -> str:
    """Return the text of a gates file, by default the standing one.

    Raises
    ------
    ValueError
        If the file cannot be read; the sentence gives the system's reason.
    """
    if path is None:
        return files("comparisons.data").joinpath("gates.toml").read_text(encoding="utf-8")
    return read_text(path, "the gates file")


def of_tier(gates: Iterable[Gate], tier: str) -> list[Gate]:
    """Return the gates of a tier and of the tiers before it."""
    return [gate for gate in gates if TIERS.index(gate.tier) <= TIERS.index(tier)]
