"""Commands that make the atlas: design of a sweep, table of its nodes, fit.

python -m fscm.interpolation design SWEEP.toml LOWER UPPER CRITICAL
python -m fscm.interpolation collect NODES.csv RESULTS.csv...
python -m fscm.interpolation fit NODES.csv
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

from fscm.interpolation.atlas import atlas
from fscm.interpolation.building import build, layouts
from fscm.interpolation.components import CRITICAL
from fscm.interpolation.design import critical_nodes, lower_nodes, sweep_text, upper_nodes
from fscm.interpolation.nodes import Nodes, collected
from fscm.interpolation.storage import write

__all__ = ["main"]


def design(path: str, lower: str, upper: str, critical: str) -> None:
    """Write a sweep file with numbers of nodes in the two patches and in the plane (n, k)."""

    def known(n: float, k: float) -> float:
        return float(atlas(n, k, 1.0, CRITICAL).value)

    above = upper_nodes(int(upper), known)
    text = sweep_text(critical_nodes(int(critical)), [*lower_nodes(int(lower)), *above], above)
    Path(path).write_text(text, encoding="utf-8")


def collect(path: str, *results: str) -> None:
    """Write the table of nodes of the results of sweeps."""
    collected(Path(result) for result in results).write(Path(path))


def fit(path: str) -> None:
    """Fit the series to a table of nodes, write them into the package, and print the deviations."""
    folder = Path(str(files("fscm.interpolation") / "data"))
    found = build(Nodes.read(Path(path)), layouts(folder / "layouts.json"))
    write(folder, found)
    for name, row in found.record.items():
        print(name, row)


# Function, and the least and the largest number of its arguments.
_COMMANDS: dict[str, tuple[Callable[..., None], int, float]] = {
    "design": (design, 4, 4),
    "collect": (collect, 2, math.inf),
    "fit": (fit, 1, 1),
}


def main(arguments: list[str]) -> int:
    """Run a command; return the exit status."""
    name, *others = arguments or [""]
    if name not in _COMMANDS or not _COMMANDS[name][1] <= len(others) <= _COMMANDS[name][2]:
        print(f"usage: one of\n{(__doc__ or '').partition(chr(10) * 2)[2]}", file=sys.stderr)
        return 2
    try:
        _COMMANDS[name][0](*others)
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
