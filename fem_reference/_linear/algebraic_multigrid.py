"""Import of pyamg that also works without docstrings (``python -OO``, ``PYTHONOPTIMIZE=2``).

pyamg appends a list of names to the docstrings of two of its packages while it is imported.  Python without
docstrings has None there, and the import ends with a `TypeError`.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec, module_from_spec
from types import ModuleType

__all__ = ["pyamg"]

#: The packages that append to their docstring, in the order of import.
_APPENDING = ("pyamg", "pyamg.util")


def _import_without_docstrings() -> None:
    """Execute pyamg with empty docstrings in place of None."""
    modules: list[ModuleType] = []
    for name in _APPENDING:
        spec = find_spec(name)
        if spec is None or spec.loader is None:
            raise ModuleNotFoundError(f"there is no package {name}", name=name)
        module = module_from_spec(spec)
        module.__doc__ = ""
        sys.modules[name] = module
        modules.append(module)
    for module in reversed(modules):
        module.__spec__.loader.exec_module(module)  # type: ignore[union-attr]  # checked above
    modules[0].util = modules[1]  # type: ignore[attr-defined]  # as the import does


try:
    if sys.flags.optimize >= 2 and "pyamg" not in sys.modules:
        _import_without_docstrings()

    import pyamg
except ImportError as error:
    raise ModuleNotFoundError(
        f"the finite elements are solved with the package pyamg, which cannot be loaded ({error}): pip install pyamg",
        name="pyamg",
    ) from error
