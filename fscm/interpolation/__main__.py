"""Commands that make the data of the atlas (see docs/atlas.md).

python -m fscm.interpolation design SWEEP.toml LOWER UPPER CRITICAL
python -m fscm.interpolation collect NODES.csv RESULTS.csv...
python -m fscm.interpolation fit NODES.csv
python -m fscm.interpolation curves PATHS OTHERS
python -m fscm.interpolation states NODES DEGREE
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from fscm.interpolation.builder.building import build, layouts, write
from fscm.interpolation.builder.curve_fit import fitted_curves
from fscm.interpolation.builder.curve_nodes import curve_nodes, solve_nodes, solved_nodes
from fscm.interpolation.builder.design import critical_nodes, lower_nodes, sweep_text, upper_nodes
from fscm.interpolation.builder.pull_off_states import fit_states
from fscm.interpolation.curve.series import DATA

__all__ = ["collect", "main", "nodes_in"]

_PARAMETERS = ["n", "k", "mu"]


def nodes_in(path: Path) -> pd.DataFrame:
    """The table of nodes in a file."""
    return pd.read_csv(path, dtype=str).astype(float)  # every digit


def collect(path: Path, results: Sequence[Path]) -> None:
    """Write the table of nodes from the tables `results.csv` of sweeps with the model `fscm`."""
    rows = pd.concat([pd.read_csv(result, dtype=str) for result in results])
    rows = rows[rows["model"] == "fscm"].astype(dict.fromkeys([*_PARAMETERS, "value", "u_num"], float))
    rows.loc[rows["status"] != "ok", ["value", "u_num"]] = float("nan")
    latest = rows.groupby([*_PARAMETERS, "quantity"])[["value", "u_num"]].last().unstack("quantity")
    table = pd.DataFrame(index=latest.index)
    for name in latest["value"].columns:
        table[name] = latest["value", name]
        table[f"u_{name}"] = latest["u_num", name].map("{:.1e}".format, na_action="ignore")
    table.dropna(axis=1, how="all").to_csv(path)


def main(arguments: list[str] | None = None) -> None:
    """Run a command."""
    parser = argparse.ArgumentParser(prog="python -m fscm.interpolation", description="Make the data of the atlas.")
    commands = parser.add_subparsers(dest="command", required=True)
    design = commands.add_parser("design", help="write a sweep file with these numbers of nodes")
    design.add_argument("path", type=Path)
    for name in ("lower", "upper", "critical"):
        design.add_argument(name, type=int)
    collected = commands.add_parser("collect", help="write the table of nodes from the results of sweeps")
    collected.add_argument("path", type=Path)
    collected.add_argument("results", type=Path, nargs="+")
    commands.add_parser("fit", help="fit the series to a table of nodes").add_argument("path", type=Path)
    curves = commands.add_parser("curves", help="trace the nodes of the force curves into a file, and fit the series")
    curves.add_argument("path", type=Path)
    curves.add_argument("others", type=int, help="nodes besides spheres and homogeneous solids")
    states = commands.add_parser("states", help="compute states of least load in batches, and fit the series to them")
    states.add_argument("nodes", type=int)
    states.add_argument("degree", type=int)
    options = parser.parse_args(arguments)
    if options.command == "design":
        above = upper_nodes(options.upper)
        text = sweep_text(critical_nodes(options.critical), [*lower_nodes(options.lower), *above], above)
        options.path.write_text(text, encoding="utf-8")
    elif options.command == "collect":
        collect(options.path, options.results)
    elif options.command == "states":
        print(fit_states(options.nodes, options.degree))
    elif options.command == "curves":
        solve_nodes(curve_nodes(options.others), options.path)
        series, sizes = fitted_curves(solved_nodes(options.path))
        series.save(DATA)
        print(sizes)
    else:
        data = build(nodes_in(options.path), layouts())
        write(data)
        for name, row in data.record.items():
            print(name, row)


if __name__ == "__main__":
    main()
