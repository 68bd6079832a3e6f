"""Examples in the docstrings."""

import doctest
import importlib

import pytest

from tests.paths import ROOT

#: Every module with an example.
MODULES = sorted(
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    for package in ("fscm", "fem_reference", "comparisons")
    for path in (ROOT / package).rglob("*.py")
    if ">>> " in path.read_text(encoding="utf-8")
)
#: Modules whose examples solve several problems, or by finite elements, half a second or more; what they show is
#: tested elsewhere too.
LONG = {
    "fscm.errors",
    "fscm.experiment",
    "comparisons.pipeline.figures",
    "comparisons.paper.figures.functions",
    "comparisons.paper.printed_values",
    "comparisons.problem.equivalent_solid",
    "comparisons.description.equivalent_power_law",
    "comparisons.models.fem_model",
    "comparisons.models.fscm_model",
    "comparisons.paper.tasks",
    "fem_reference.large_strain",
    "fem_reference.verification.element_checks",
}


def test_there_are_examples() -> None:
    assert len(MODULES) > 60
    assert set(MODULES) > LONG


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.heavy) if name in LONG else name for name in MODULES]
)
def test_examples(name: str) -> None:
    results = doctest.testmod(
        importlib.import_module(name), optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    )
    assert results.failed == 0
