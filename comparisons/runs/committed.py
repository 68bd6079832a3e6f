"""Paths of the committed tables in a clone."""

from __future__ import annotations

from pathlib import Path

from comparisons.data.file_names import BASELINE_FOLDER

#: The clone whose packages run.
_CLONE = Path(__file__).resolve().parents[2]


def committed(name: str | Path) -> Path:
    """Return the path of a file or folder of the baseline, in the working folder or in the clone whose packages run.

    Parameters
    ----------
    name : str or Path
        Relative to the folder of the baseline; a folder has to have a file.

    Raises
    ------
    ValueError
        If it is in neither of them.

    Examples
    --------
    >>> committed("quick.csv").name, committed("paper").name
    ('quick.csv', 'paper')
    """
    for folder in (BASELINE_FOLDER, _CLONE / BASELINE_FOLDER):
        path = folder / name
        if path.is_file() or (path.is_dir() and any(path.iterdir())):
            return path
    raise ValueError(f"{BASELINE_FOLDER / name} of the baseline is missing: call this in the root folder of a clone")
