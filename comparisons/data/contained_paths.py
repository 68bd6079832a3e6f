"""Paths that a file names: only those below a folder are used, since the file may come from elsewhere."""

from __future__ import annotations

import os
from pathlib import Path, PurePath


def path_inside(folder: Path, name: str) -> Path:
    """Return the path of a file that another file names.

    Parameters
    ----------
    folder : Path
        That the file must be in, at any depth.
    name : str
        As it is written, relative to the folder.

    Raises
    ------
    ValueError
        One sentence, if the name is absolute or has a part "..", or a symbolic link on its way leads out of the folder.

    Examples
    --------
    >>> path_inside(Path("results"), "inputs/pad.toml").as_posix()
    'results/inputs/pad.toml'
    >>> path_inside(Path("results"), "../pad.toml")
    Traceback (most recent call last):
    ValueError: the path '../pad.toml' leads out of the folder results
    """
    path, written = folder / name, PurePath(name)
    # A drive, too: "D:pad.toml" is neither absolute nor below the folder.
    leads_out = written.is_absolute() or written.drive or ".." in written.parts or "\0" in name
    # Not Path.resolve(), which raises RuntimeError at a loop of links in Python 3.11 and 3.12.
    root = os.path.realpath(folder)
    if leads_out or os.path.commonpath([root, os.path.realpath(path)]) != root:
        raise ValueError(f"the path {name!r} leads out of the folder {folder}")
    return path


def refuse_link(path: Path) -> None:
    """Refuse a symbolic link in place of a file that is written in place: its target would be changed.

    Raises
    ------
    ValueError
        One sentence, if the path is a link.
    """
    if path.is_symlink():
        raise ValueError(f"{path} is a symbolic link, whose target would be changed; remove it, or give another folder")
