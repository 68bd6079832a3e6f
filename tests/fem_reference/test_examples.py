"""The examples in the documentation strings run and give what they show."""

import doctest
import importlib
import pkgutil

import pytest

import fem_reference

MODULES = sorted(m.name for m in pkgutil.iter_modules(fem_reference.__path__, "fem_reference."))


@pytest.mark.parametrize("name", MODULES)
def test_examples(name):
    result = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert result.failed == 0
