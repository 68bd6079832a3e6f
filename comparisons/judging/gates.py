"""Gates as data: what is required of which model, in which cases, within which limits, and on what grounds.

A gate compares one quantity of a candidate with that of a reference.  Unknown and missing keys are refused,
so that a misspelt one cannot pass unnoticed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from importlib.resources import files
from pathlib import Path
from typing import Any

from comparisons.data.toml_text import is_real, names, parse
from comparisons.judging.gate_checks import PARAMETERS, check_compared, check_numbers, label, plain_text
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.registry import MODELS
from comparisons.runs.cases import TIERS, Case, Grid

__all__ = ["GIVEN", "METRICS", "Gate", "gates_text", "load_gates", "of_tier"]

#: The candidate of a gate for every model that is given to a run, whatever its name.
GIVEN = "given"

METRICS = {
    "rel": "(candidate - reference) / |reference|",
    "abs": "candidate - reference",
    "range-relative": "(candidate - reference) / range of the reference over the cases",
    "en": "(candidate - reference) / sqrt(u_candidate^2 + u_reference^2): is the error inside what both claim?",
    "curve": "largest distance of the two curves, as a fraction of the picture",
}
BASES = ("derived", "published", "measured")
NOT_APPLICABLE = ("error", "leave-out")


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
        Names of models; the candidate `GIVEN` stands for every model given to a run.
    cases : dict
        Ranges [low, high] of n, k, mu and nu, ends included, and tags of grids; what is not named is not
        restricted.
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
        Where the limits come from: one of "derived", "published", "measured".
    grounds : str
        The derivation in short, the place published, or the worst case measured.
    min_cases : int
        Fewer evaluated cases are an error.
    tier : str
        The first of `TIERS` that judges it.
    worst_measured : float or None
        For "measured": the error of largest size when the limits were set.
    reference_at : dict
        Parameters at which the reference is taken instead of those of the case, e.g. ``{k = 1}``.
    rival : str or None
        A second model: the error is then by how much the candidate's exceeds the rival's in size.
    not_applicable : str
        What a case is of which a model says that it does not apply: an error, or left out.
    expected_failure : str or None
        Why every case is known to fail; one that passes is then reported.
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
    reference_at: Mapping[str, float] = field(default_factory=dict)
    rival: str | None = None
    not_applicable: str = "error"
    expected_failure: str | None = None

    def selects(self, grid: Grid, case: Case) -> bool:
        """Whether a case of a grid is one of the gate's; tags name grids, or properties of them.

        Examples
        --------
        >>> gate = load_gates(gates_text())[0]
        >>> gate.selects(Grid("a", "A", "quick", "b", (), (), ()), Case(2, 0, 1))
        False
        """
        tags = self.cases.get("tags")
        if tags is not None and not {grid.id, *grid.tags} & set(tags):
            return False
        return all(self._within(name, getattr(case, name)) for name in PARAMETERS if name in self.cases)

    def _within(self, name: str, value: float | None) -> bool:
        low, high = self.cases[name]
        return value is not None and low <= value <= high

    def reference_case(self, case: Case) -> Case:
        """Return the case in which the reference is asked."""
        return replace(case, **self.reference_at)


_FIELDS: dict[str, type | tuple[type, ...]] = {
    "id": str,
    "requirement": str,
    "quantity": str,
    "candidate": str,
    "reference": str,
    "cases": dict,
    "metric": str,
    "lower": (int, float),
    "upper": (int, float),
    "max_reference_uncertainty": (int, float),
    "basis": str,
    "grounds": str,
    "min_cases": int,
    "tier": str,
}
_OPTIONAL: dict[str, type | tuple[type, ...]] = {
    "max_candidate_uncertainty": (int, float),
    "worst_measured": (int, float),
    "reference_at": dict,
    "rival": str,
    "not_applicable": str,
    "expected_failure": str,
}
#: Sentences for readers.
_TEXTS = ("requirement", "grounds", "expected_failure")


def load_gates(text: str, models: Iterable[str] = (), source: str = "the gates file") -> list[Gate]:
    """Read gates from TOML text.

    Parameters
    ----------
    text : str
        ``[[gate]]`` tables and nothing else.
    models : iterable of str
        Names of models that may be named besides those of the register.
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
    ValueError: gate 1: basis, candidate, cases, ... missing or unknown; ...
    """
    tables = parse(text, source)
    if tables.keys() != {"gate"}:
        raise ValueError(f"{source}: a gates file holds [[gate]] tables and nothing else, not {names(tables)}")
    if not isinstance(tables["gate"], list) or not all(isinstance(table, dict) for table in tables["gate"]):
        raise ValueError(f"{source}: a gates file holds [[gate]] tables and nothing else; its gate is something else")
    known = {*MODELS, *models}
    read = [_gate(table, label(table, number), known) for number, table in enumerate(tables["gate"], start=1)]
    ids = [gate.id for gate in read]
    if twice := sorted({id for id in ids if ids.count(id) > 1}):
        raise ValueError(f"the id of a gate must be its own; {', '.join(twice)} is there twice")
    return read


def _gate(table: dict[str, Any], where: str, models: set[str]) -> Gate:
    wrong = sorted((_FIELDS.keys() - table.keys()) | (table.keys() - _FIELDS.keys() - _OPTIONAL.keys()))
    if wrong:
        shown = [key if key.isprintable() else ascii(key) for key in wrong]
        raise ValueError(
            f"{where}: {', '.join(shown)} missing or unknown; a gate has {', '.join(_FIELDS)} "
            f"and may have {', '.join(_OPTIONAL)}"
        )
    for key, kind in (_FIELDS | _OPTIONAL).items():
        fits = is_real if kind == (int, float) else lambda value, kind=kind: isinstance(value, kind)
        if key in table and (not fits(table[key]) or isinstance(table[key], bool)):
            raise ValueError(f"{where}: {key} = {table[key]!r} has the wrong type")
    gate = Gate(**table | {key: plain_text(key, table[key], where) for key in _TEXTS if key in table})
    check_compared(gate, where)
    for key in ("candidate", "reference", "rival"):
        name = getattr(gate, key)
        if name is not None and name not in models and not (key == "candidate" and name == GIVEN):
            raise ValueError(f"{where}: unknown {key} {name!r}; the models are {', '.join(sorted(models))}")
    for key, allowed in {
        "metric": METRICS,
        "basis": BASES,
        "tier": TIERS,
        "not_applicable": NOT_APPLICABLE,
    }.items():
        if getattr(gate, key) not in allowed:
            raise ValueError(f"{where}: {key} = {getattr(gate, key)!r} is not one of {', '.join(allowed)}")
    quantities = CURVES if gate.metric == "curve" else QUANTITIES
    if gate.quantity not in quantities:
        raise ValueError(
            f"{where}: unknown quantity {gate.quantity!r} for the metric {gate.metric}; "
            f"known are {', '.join(quantities)}"
        )
    check_numbers(gate, where)
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
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise ValueError(f"the gates file {path} cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise ValueError(f"the gates file {path} is not UTF-8 text") from None


def of_tier(gates: Iterable[Gate], tier: str) -> list[Gate]:
    """Return the gates of a tier and of the tiers before it."""
    return [gate for gate in gates if TIERS.index(gate.tier) <= TIERS.index(tier)]
