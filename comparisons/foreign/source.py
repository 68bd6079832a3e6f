"""Loading a model from a file, and what identifies its code; run in the child process only."""

from __future__ import annotations

import hashlib
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

__all__ = ["load_file", "source_digest"]


def load_file(file: Path, attribute: str) -> object:
    """Return what a file defines under a name; modules beside the file can be imported by it.

    Raises
    ------
    AttributeError
        If the file does not define it.  Whatever the file raises comes through.
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


def source_digest(cls: type) -> str:
    """Return a SHA-256 of the files a class came from: its package, or its file and the modules beside it.

    Only what has been imported is hashed; a module that loads another later, or reads data, is not seen
    through.
    """
    file = getattr(sys.modules.get(cls.__module__), "__file__", None)
    if file is None:
        return hashlib.sha256(b"").hexdigest()
    top = cls.__module__.partition(".")[0]
    package = getattr(sys.modules.get(top), "__path__", None)
    root = Path(next(iter(package))) if package else Path(file).parent
    files = {Path(file)}
    for name, module in list(sys.modules.items()):
        loaded = getattr(module, "__file__", None)
        # Without a package, the folder may be site-packages: then the file stands alone.
        inside = name.partition(".")[0] == top if package else root.name != "site-packages"
        if isinstance(loaded, str) and inside and Path(loaded).is_relative_to(root):
            files.add(Path(loaded))
    digest = hashlib.sha256()
    for path in sorted(files):
        digest.update(f"{path.relative_to(root).as_posix()}\0".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()
