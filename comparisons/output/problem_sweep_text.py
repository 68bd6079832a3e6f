"""Table of a sweep over a problem file as lines of text."""

from __future__ import annotations

import pandas as pd

from comparisons.problem_file.units import si_text

__all__ = ["problem_lines"]

#: Columns that every table has; the others are the varied keys.
_OWN = ("model", "model_version", "quantity", "value", "u_num", "unit", "status", "reason", "seconds")


def problem_lines(table: pd.DataFrame) -> list[str]:
    """Return a line for each row: the varied keys, the model, and the value with its bound or the status.

    Examples
    --------
    >>> row = {"model": "fscm", "quantity": "pull_off_force", "punch.R [m]": 1e-7, "value": 2e-8, "u_num": 1.54e-15}
    >>> for line in problem_lines(pd.DataFrame([row | {"unit": "N", "status": "ok"}])):
    ...     print(line)
    punch.R  model  pull_off_force
    100 nm   fscm   20.0000000(16) nN
    """
    varied = [name for name in table.columns if name not in _OWN]
    lines: list[str] = []
    for quantity, rows in table.groupby("quantity", sort=False):
        cells = [[*(name.partition(" [")[0] for name in varied), "model", str(quantity)]]
        for row in rows.to_dict("records"):
            value = si_text(row["value"], row["u_num"], row["unit"]) if row["status"] == "ok" else row["status"]
            cells.append([*(_cell(row[name], str(name)) for name in varied), row["model"], value])
        widths = [max(len(line[column]) for line in cells) for column in range(len(cells[0]))]
        lines += [
            "  ".join(f"{cell:{width}}" for cell, width in zip(line, widths, strict=True)).rstrip() for line in cells
        ]
    return lines


def _cell(value: float | str, name: str) -> str:
    if isinstance(value, str):
        return value
    unit = name.partition(" [")[2].removesuffix("]") or "1"
    return f"{value:.6g} {unit}" if "^" in unit else si_text(float(f"{value:.6g}"), 0.0, unit)
