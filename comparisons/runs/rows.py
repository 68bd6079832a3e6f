"""Rows of results: one for each model, quantity and case, as a table with declared column types."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass

import pandas as pd
import pyarrow as pa

__all__ = ["COLUMNS", "CURVE_COLUMNS", "Row", "curve_frame", "frame"]


@dataclass(frozen=True, slots=True)
class Row:
    """The result of one evaluation: of one quantity, by one model, in one case.

    Attributes
    ----------
    model, model_version, quantity : str
        Names, as in `comparisons.registry` and `comparisons.quantities`.
    n, k, mu : float
        The problem.
    nu : float or None
        Poisson's ratio, if one was prescribed.
    value, u_num : float or None
        The result and its numerical uncertainty, in `unit`; None unless `status` is ``"ok"``.
    unit : str
        The scale of the dimensionless value.
    status : str
        ``"ok"``, ``"not-applicable"`` or ``"failed"``.
    reason : str
        One sentence when there is no value, else empty.
    size, iterations, residual
        Of the discrete problem; None when there is no value.
    seconds : float
        Wall-clock time: what the model states, or else the duration of the call.
    """

    model: str
    model_version: str
    quantity: str
    n: float
    k: float
    mu: float
    nu: float | None
    value: float | None
    u_num: float | None
    unit: str
    status: str
    reason: str
    size: int | None
    iterations: int | None
    residual: float | None
    seconds: float
    observed_order: float | None = None
    points: tuple[list[float], list[float], float] | None = None

    @property
    def key(self) -> tuple[str, str, float, float, float, float | None]:
        """What identifies the evaluation; a run makes each once."""
        return self.model, self.quantity, self.n, self.k, self.mu, self.nu


_TEXT, _REAL, _COUNT = pa.string(), pa.float64(), pa.int64()

#: Column types of the stored table, in order.
COLUMNS = pa.schema(
    [
        ("model", _TEXT),
        ("model_version", _TEXT),
        ("quantity", _TEXT),
        ("n", _REAL),
        ("k", _REAL),
        ("mu", _REAL),
        ("nu", _REAL),
        ("value", _REAL),
        ("u_num", _REAL),
        ("observed_order", _REAL),
        ("unit", _TEXT),
        ("status", _TEXT),
        ("reason", _TEXT),
        ("size", _COUNT),
        ("iterations", _COUNT),
        ("residual", _REAL),
        ("seconds", _REAL),
    ]
)

#: Column types of the stored curves: one row a point, and one row for a curve that there is not.
CURVE_COLUMNS = pa.schema(
    [
        ("model", _TEXT),
        ("model_version", _TEXT),
        ("quantity", _TEXT),
        ("n", _REAL),
        ("k", _REAL),
        ("mu", _REAL),
        ("nu", _REAL),
        ("point", _COUNT),
        ("x", _REAL),
        ("y", _REAL),
        ("u_distance", _REAL),
        ("unit", _TEXT),
        ("status", _TEXT),
        ("reason", _TEXT),
        ("seconds", _REAL),
    ]
)

_ORDER = ["quantity", "model", "n", "k", "mu", "nu"]


def frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the rows as a sorted pandas table with the columns of `COLUMNS`."""
    table = pa.Table.from_pylist([asdict(row) for row in rows], schema=COLUMNS)
    return table.to_pandas().sort_values(_ORDER, ignore_index=True)


def curve_frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the curves as a sorted pandas table with the columns of `CURVE_COLUMNS`."""
    records = [
        asdict(row) | {"point": number, "x": x, "y": y, "u_distance": row.points[2] if row.points else None}
        for row in rows
        for number, (x, y) in enumerate(zip(*row.points[:2], strict=True) if row.points else [(None, None)])
    ]
    table = pa.Table.from_pylist(records, schema=CURVE_COLUMNS)
    return table.to_pandas().sort_values([*_ORDER, "point"], ignore_index=True)
