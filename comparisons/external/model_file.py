"""Import of a model from a file, in the child process only."""

from __future__ import annotations

import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

__all__ = ["load_file"]


def load_file(file: Path, attribute: str) -> object:
    """Return what a file defines under a name; modules beside the file can be imported by it.

    Raises
    ------
    AttributeError
        If the file does not define it.  An exception that the file raises is not caught.
    """
    sys.path.insert(0, str(file.parent))
    spec = spec_from_file_location(file.stem, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"{file.name} is not a Python file")
    module = module_from_spec(spec)
    # Registered first, as an import does: dataclasses look their module up.
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    if not hasattr(module, attribute):
        raise AttributeError(f"{file.name} does not define {attribute}")
    made: object = getattr(module, attribute)
    return made
