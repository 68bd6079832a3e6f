"""Examples in the docstrings."""

import doctest
import importlib
import pkgutil

import pytest

import comparisons
import fem_reference
import fscm

OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
MODULES = sorted(
    module.name
    for package in (fscm, fem_reference, comparisons)
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + ".")
)


#: Modules whose examples solve several problems, or of other solids than power laws, half a second or more;
#: the functions that users call are not among them.
LONG = {
    "comparisons.paper.figures.gradient_effect",
    "comparisons.paper.studies.error_maps",
    "comparisons.paper.values.printed_values",
    "comparisons.paper.studies.graded_solids",
    "comparisons.paper.studies.layered_adhesion",
    "comparisons.problem.elastic_energy",
    "comparisons.description.equivalent_power_law",
    "fem_reference.verification.element_checks",
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.heavy) if name in LONG else name for name in MODULES]
)
def test_examples(name: str) -> None:
    module = importlib.import_module(name)
    failed, _ = doctest.testmod(module, optionflags=OPTIONS)
    assert failed == 0


def test_there_are_examples() -> None:
    assert set(MODULES) > LONG
    finder = doctest.DocTestFinder(exclude_empty=True)
    examples = sum(len(t.examples) for n in MODULES for t in finder.find(importlib.import_module(n)))
    assert examples > 60
