"""Paths of the committed tables: of the clone, or the copy that a wheel has."""

from __future__ import annotations

from pathlib import Path

from comparisons.data.file_names import BASELINE_FOLDER

__all__ = ["committed"]

_ROOT = Path(__file__).resolve().parents[2]

#: Folders besides that of the working folder: of a clone whose packages run, and of the copy in a wheel, which
#: `comparisons/build_step` makes.
_INSTALLED = (_ROOT / BASELINE_FOLDER, _ROOT / "comparisons" / "data" / "baseline")


def committed(name: str | Path) -> Path:
    """Return the path of a file or folder of the baseline.

    The first that exists counts: in the clone that is the working folder, in the clone whose packages run, in the
    installation.

    Parameters
    ----------
    name : str or Path
        Relative to the folder of the baseline; a folder has to have a file.

    Raises
    ------
    ValueError
        If it is in none of them.

    Examples
    --------
    >>> committed("quick.csv").name, committed("paper").name
    ('quick.csv', 'paper')
    """
    for folder in (BASELINE_FOLDER, *_INSTALLED):
        path = folder / name
        if path.is_file() or (path.is_dir() and any(path.iterdir())):
            return path
    raise ValueError(
        f"{BASELINE_FOLDER / name} of the baseline is neither in the working folder nor in the installation of "
        "fscm-bench: install the wheel of fscm-bench again, or call this in the root folder of a clone"
    )
