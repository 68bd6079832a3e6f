"""Digests of code: of all files that numbers depend on, and of those that the values of the references depend on."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable
from pathlib import Path

__all__ = ["CODE", "NOT_INSTALLED", "SOLVER_MODULES", "code_in", "files_digest", "solver_digest"]

#: Suffixes of the files that numbers depend on.
CODE = {".py", ".toml"}

#: Folders of a clone that a wheel has not, or has elsewhere.
NOT_INSTALLED = tuple(Path("comparisons", name) for name in ("build_step", "pytest_entry", "start_entry"))

#: Modules of `comparisons` on which the values of the references depend: what importing their two models loads.
SOLVER_MODULES = (
    "model.py",
    "models/fem_model.py",
    "models/fscm_model.py",
    "models/gibson_limit.py",
    "models/solver.py",
    "numerics/curve_distance.py",
    "numerics/grid_convergence.py",
    "quantities/__init__.py",
    "quantities/points.py",
    "quantities/quantity.py",
)
#: Folder of the atlas, which is fitted to values of the solver and changes none.
_ATLAS = Path("fscm", "interpolation")


def code_in(folder: Path) -> list[Path]:
    """Return the Python and TOML files of a folder and of those in it, sorted; no link to a folder is followed.

    Examples
    --------
    >>> [path.name for path in code_in(Path(__file__).parents[1]) if path.name.startswith("code_")]
    ['code_files.py']
    """
    # Not `rglob`, which makes a path of every file that Python compiled.
    return sorted(
        Path(where, name) for where, _, names in os.walk(folder) for name in names if os.path.splitext(name)[1] in CODE
    )


def files_digest(root: Path, paths: Iterable[Path]) -> str:
    """Return the SHA-256 of the names, relative to `root`, and the contents of the Python and TOML files of `paths`."""
    digest = hashlib.sha256()
    for path in paths:
        if path.suffix in CODE:
            digest.update(f"{path.relative_to(root).as_posix()}\0".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def solver_digest(root: Path | None = None) -> str:
    """Return the SHA-256 of the files under `root` (by default, those that run) that fix the references' values.

    These are both solvers without the atlas, and the modules of `comparisons` that pose their problems and scale their
    results.  The judge and the pages change no value, so that they do not count.  The versions of NumPy and SciPy do
    not either: with others the values agree within their bounds, of which every run checks a few.

    Examples
    --------
    >>> len(solver_digest())
    64
    """
    root = root or Path(__file__).resolve().parents[2]
    packages = [path for package in ("fscm", "fem_reference") for path in code_in(root / package)]
    packages = [path for path in packages if path.parent != root / _ATLAS]
    return files_digest(root, [*packages, *(root / "comparisons" / name for name in SOLVER_MODULES)])
