"""CPU time now, then and at the floor: the rows of two benchmarks, each in units of its own bare interpreter.

The bare interpreter does the same work in every version of the code, so that the ratios of two machines compare.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from comparisons.bench.cold_starts import BARE, COLD_STARTS
from comparisons.bench.kinds import KINDS, KINDS_OF_PROBLEMS
from comparisons.data.file_names import BENCH
from comparisons.output.style import COLOURS, new_figure, styled

#: Line above its summary; names of its table and figure.
TITLE = "CPU time over that of a bare interpreter: now, then and at the floor"
FILES = ("progress.csv", "progress.png")

#: Parts whose rows are compared.
_PARTS = (COLD_STARTS, KINDS_OF_PROBLEMS)


def stored_tables(folder: Path) -> dict[str, pd.DataFrame]:
    """Return the tables of a benchmark by part.

    Raises
    ------
    ValueError
        If it is not the folder of a benchmark with cold starts.
    """
    if not (folder / BENCH).is_file():
        raise ValueError(f"{folder} is not the folder of a finished `fscm-bench bench`: it has no {BENCH}")
    files = {part.name: part.files(folder)[0] for part in _PARTS}
    tables = {name: pd.read_csv(file) for name, file in files.items() if file.is_file()}
    if _rows(tables).empty:
        raise ValueError(
            f"{folder} has no time of `{BARE}`, to which times are compared: measure the cold starts there"
        )
    return tables


def progress(tables: Mapping[str, pd.DataFrame], earlier: Mapping[str, pd.DataFrame] | None) -> pd.DataFrame:
    """Return the time of each row now, then and at the floor, in bare interpreters, with their ratios.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        By part; without the bare interpreter there are no rows.
    earlier : mapping of str to DataFrame, optional
        Of another benchmark.

    Examples
    --------
    >>> def table(seconds, floor):
    ...     rows = {"command": ["python -c pass", "cite"], "cpu_seconds": [0.1, seconds], "floor_seconds": [0.1, floor]}
    ...     return {"cold-starts": pd.DataFrame({**rows, "status": "ok"})}
    >>> progress(table(0.5, 0.2), table(1.0, 0.2)).loc["cite"].round(9).to_dict()
    {'now': 5.0, 'then': 10.0, 'floor': 2.0, 'then_over_now': 2.0, 'now_over_floor': 2.5}
    """
    now, then = _rows(tables), _rows(earlier or {})
    table = pd.DataFrame({"now": now["time"], "then": then["time"].reindex(now.index), "floor": now["floor"]})
    return table.assign(then_over_now=table["then"] / table["now"], now_over_floor=table["now"] / table["floor"])


def _rows(tables: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Return time and floor of each row without failure, in bare interpreters."""
    named = []
    for part in _PARTS:
        if part.name in tables:
            rows = tables[part.name]
            rows = rows[rows["status"] == "ok"]
            names = rows.apply(_command if part is COLD_STARTS else _problem, axis="columns")
            # An earlier version has no floor.
            floors = rows.get("floor_seconds", float("nan"))
            named.append(pd.DataFrame({"row": names, "time": rows["cpu_seconds"], "floor": floors}))
    if not named:
        return pd.DataFrame(columns=["time", "floor"], dtype=float)
    joined = pd.concat(named).set_index("row").astype(float)
    if BARE not in joined.index:
        return joined[:0]
    return joined / joined.loc[BARE, "time"]


def _command(row: pd.Series) -> str:
    return str(row["command"]).removesuffix(" --quantity pull_off_force")


def _problem(row: pd.Series) -> str:
    kind = KINDS.get(row["problem"])
    return f"{row['problem']}, {row['size']:g} {kind.size if kind else 'of an earlier version'}, {row['model']}"


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Return what is printed, without the ratios: a line has 80 columns."""
    return table[["now", "then", "floor"]].dropna(axis="columns", how="all").reset_index(names="row")


def draw(table: pd.DataFrame) -> Figure:
    """Draw a line for each row, from the floor to now and then."""
    lines = table[::-1]
    with styled():
        figure = new_figure(6.8, 0.9 + 0.2 * len(lines))
        axes = figure.subplots()
        heights = range(len(lines))
        axes.hlines(heights, lines["floor"].fillna(lines["now"]), lines["now"], color=COLOURS[-1], lw=0.8)
        for name, marker, colour, filling in (
            ("floor", "|", COLOURS[0], "full"),
            ("then", "o", COLOURS[1], "none"),
            ("now", "o", COLOURS[0], "full"),
        ):
            if lines[name].notna().any():
                axes.plot(lines[name], heights, marker, color=colour, fillstyle=filling, ls="none", label=name)
        axes.set_xscale("log")
        axes.set_yticks(heights, list(lines.index))
        axes.set_ylim(-0.8, len(lines) - 0.2)
        axes.set_xlabel("CPU time over that of a bare interpreter")
        axes.legend(loc="upper right")
    return figure
