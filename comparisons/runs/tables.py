"""Stored results: one tidy row per model, quantity and case; atomic files.

The tables written at the end of a run (`results.csv`, `results.parquet`) are sorted, and the CSV depends on code and
cases alone: wall-clock times are only in the Parquet.
"""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from comparisons.console.exit_status import full_disk

__all__ = [
    "COLUMNS",
    "CURVE_COLUMNS",
    "Row",
    "atomic",
    "csv_text",
    "curve_frame",
    "frame",
    "plain_text",
    "prepare_folder",
    "read_table",
    "writable_file",
    "write_curves",
    "write_json",
    "write_results",
    "write_table",
    "writing",
]


@dataclass(frozen=True, slots=True)
class Row:
    """What one model answered to one question.

    Attributes
    ----------
    model, model_version, quantity : str
        Who was asked what.
    n, k, mu : float
        The problem.
    nu : float or None
        Poisson's ratio, if one was prescribed.
    value, u_num : float or None
        The answer and its numerical uncertainty, in `unit`; None unless `status` is ``"ok"``.
    unit : str
        The scale of the dimensionless value.
    status : str
        ``"ok"``, ``"not-applicable"`` or ``"failed"``.
    reason : str
        One sentence when there is no value, else empty.
    size, iterations, residual
        Of the discrete problem; None when there is no value.
    seconds : float
        Wall-clock time: what the model states, or else how long it took to answer.
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
        """What identifies the question; a run asks each once."""
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
_PARAMETERS = ("n", "k", "mu", "nu")

#: Start of a text that a spreadsheet evaluates, or that `csv_text` has marked already: both get an apostrophe, so that
#: `plain_text` can take away one.
_FORMULA = re.compile(r"'*[=+\-@\t]")


def prepare_folder(path: Path) -> Path:
    """Create a folder for results and make sure that files can be written there.

    Raises
    ------
    ValueError
        If it cannot be created or written; the sentence gives the system's reason.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            pass
    except OSError as error:
        if full_disk(error):
            raise OSError(f"the output folder {path} cannot be written ({error.strerror})") from error
        raise ValueError(
            f"the output folder {path} cannot be written ({error.strerror}); choose another one with --out"
        ) from None
    return path


def writable_file(path: Path) -> Path:
    """Make sure, before anything is computed, that a file can be written.

    Raises
    ------
    ValueError
        If it cannot; the sentence gives the system's reason.
    """
    if path.is_dir():
        raise ValueError(f"the file {path} cannot be written (it is a folder); choose another place")
    with _explained(path), tempfile.TemporaryFile(dir=path.parent):
        return path


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        if full_disk(error):
            raise OSError(f"the file {path} cannot be written ({error.strerror})") from error
        raise ValueError(f"the file {path} cannot be written ({error.strerror}); choose another place") from None


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Name the file in the error of the system when its content cannot be written, as on a full disk.

    Raises
    ------
    OSError
        One sentence with the path and the system's reason.
    """
    try:
        yield
    except OSError as error:
        raise OSError(f"the file {path} cannot be written ({error.strerror or error})") from error


@contextmanager
def atomic(path: Path) -> Iterator[IO[bytes]]:
    """Open a temporary file beside `path` that takes its place only when the block ends without an error.

    Raises
    ------
    ValueError
        If the file cannot be written there; the sentence gives the system's reason.
    OSError
        If there is no room for its content; the sentence gives the system's reason.
    """
    with _explained(path):
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    temporary = Path(name)
    try:
        with writing(path):
            with os.fdopen(handle, "wb") as file:
                yield file
            umask = os.umask(0)
            os.umask(umask)
            temporary.chmod(0o666 & ~umask)
            temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


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


def csv_text(table: pd.DataFrame) -> str:
    """Return a table as CSV with 17 significant digits, which give every double back exactly.

    The parameters of a case are written as short as they can be exactly: 0.4, not 0.40000000000000002.  A text that a
    spreadsheet would evaluate as a formula gets an apostrophe before it; `plain_text` takes it away.

    Examples
    --------
    >>> print(csv_text(pd.DataFrame({"mu": [0.4], "value": [0.4], "reason": ["=1+1"]})), end="")
    mu,value,reason
    0.4,0.40000000000000002,'=1+1
    """
    table = _without_formulas(table)
    short = {
        name: table[name].map(lambda x: "" if pd.isna(x) else repr(float(x)).removesuffix(".0"))
        for name in _PARAMETERS
        if name in table
    }
    return table.assign(**short).to_csv(index=False, float_format="%.17g", lineterminator="\n")


def plain_text(cell: str) -> str:
    """Return the text that `csv_text` wrote as a cell.

    Examples
    --------
    >>> plain_text("'=1+1"), plain_text("-0.5"), plain_text("it's")
    ('=1+1', '-0.5', "it's")
    """
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell[1:].lstrip()) else cell


def _without_formulas(table: pd.DataFrame) -> pd.DataFrame:
    changed = {}
    for name in table.columns.difference(_PARAMETERS, sort=False):
        if not pd.api.types.is_numeric_dtype(table[name]):
            cells = [_cell(value) for value in table[name]]
            # A column without formulas keeps its type, on which the digits of its numbers depend.
            if any(cell is not value for cell, value in zip(cells, table[name], strict=True)):
                changed[name] = pd.Series(cells, index=table.index, dtype=object)
    # Models may name columns of their curves.
    return table.assign(**changed).rename(columns=_cell)


def _cell(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    # The CSV writer does not quote a carriage return, at which readers begin another row.
    text = value.replace("\r", " ") if "\r" in value else value
    return f"'{text}" if _FORMULA.match(text.lstrip()) and not _is_number(text) else text


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def write_results(table: pd.DataFrame, stem: Path) -> None:
    """Write a table of rows, as `frame` returns it; the CSV leaves out the wall-clock seconds."""
    write_table(table, stem, schema=COLUMNS, leave_out_of_csv=["seconds"])


def write_curves(table: pd.DataFrame, stem: Path) -> None:
    """Write a table of curves, as `curve_frame` returns it; the CSV leaves out the wall-clock seconds."""
    write_table(table, stem, schema=CURVE_COLUMNS, leave_out_of_csv=["seconds"])


def write_table(
    table: pd.DataFrame, stem: Path, *, schema: pa.Schema | None = None, leave_out_of_csv: Iterable[str] = ()
) -> None:
    """Write a table as `stem`.csv and `stem`.parquet, the latter with the types of `schema` if given."""
    with atomic(stem.with_suffix(".csv")) as file:
        file.write(csv_text(table.drop(columns=list(leave_out_of_csv))).encode())
    with atomic(stem.with_suffix(".parquet")) as file:
        pq.write_table(pa.Table.from_pandas(table, schema=schema, preserve_index=False), file)


def read_table(path: Path) -> pd.DataFrame:
    """Read a stored table.

    Raises
    ------
    ValueError
        If there is no such file or it is not Parquet; one sentence says which.
    """
    try:
        return pq.read_table(path).to_pandas()
    except FileNotFoundError:
        raise ValueError(f"{path} does not exist: {path.parent} is not the folder of a finished run") from None
    except (OSError, pa.ArrowException) as error:
        raise ValueError(f"{path} cannot be read as Parquet ({str(error).splitlines()[0]})") from None


def write_json(content: dict[str, Any], path: Path) -> None:
    """Write a JSON object; NaN and infinity are refused."""
    with atomic(path) as file:
        file.write(json.dumps(content, indent=2, allow_nan=False).encode() + b"\n")
