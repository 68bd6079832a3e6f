"""Command that computes the data of the atlas: python -m fscm.interpolation NODES.csv."""

from __future__ import annotations

import sys
from importlib.resources import files
from pathlib import Path

from fscm.interpolation.building import build, layouts
from fscm.interpolation.nodes import Nodes
from fscm.interpolation.storage import write


def main(arguments: list[str]) -> int:
    """Fit the series to the nodes of a file, and write them into the package."""
    if len(arguments) != 1:
        print("usage: python -m fscm.interpolation NODES.csv", file=sys.stderr)
        return 2
    folder = Path(str(files("fscm.interpolation") / "data"))
    found = build(Nodes.read(Path(arguments[0])), layouts(folder / "layouts.json"))
    write(folder, found)
    for name, row in found.record.items():
        print(name, row)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
