"""Order of the folders of fem_reference: verification after the solver."""

import ast
from pathlib import Path

import pytest

import fem_reference

ROOT = Path(fem_reference.__file__).parent

#: Folders in the order of imports; the public modules of results come after the private folders that they use.
LAYERS = (
    ("_typing", "_threads", "errors", "modulus", "punch", "laws", "solid", "problem", "accuracy"),
    ("_elastic",),
    ("_linear",),
    ("_contact",),
    ("quantities", "solution", "states", "export", "uncondensed"),
    ("verification",),
)
MODULES = [path for path in sorted(ROOT.rglob("*.py")) if path != ROOT / "__init__.py"]


def layer(name):
    return next(index for index, names in enumerate(LAYERS) if name in names)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_module_imports_from_its_own_layer_or_those_before_it(path):
    own = layer(path.relative_to(ROOT).with_suffix("").parts[0])
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = [node.module] if isinstance(node, ast.ImportFrom) else []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        for name in names:
            if name.startswith("fem_reference."):
                assert layer(name.split(".")[1]) <= own, name


def test_the_solver_does_not_load_the_verification():
    source = (ROOT / "__init__.py").read_text(encoding="utf-8")
    assert "verification" not in source
