"""A measured force-displacement curve: how it is read, and where it jumps."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comparisons.data.input_files import LARGEST_TABLE, check_regular, read_text
from comparisons.data.validation import shown
from comparisons.model import Array
from comparisons.problem.columns import column_heading
from comparisons.problem.units import NotAValue, unit_factor

#: Columns of a CSV file and their units in SI: displacement and load, or height of the base and deflection.
_COLUMNS = {"displacement": "m", "load": "N", "height": "m", "deflection": "m", "branch": ""}
_BRANCHES = ("approach", "retreat")

#: Fewest points of a curve, several for each number that is fitted.
_FEWEST = 20

#: A step of the load is a jump where it is so many standard deviations of the noise, and so many times the usual step
#: of its neighbourhood.
_NOISE, _USUAL, _NEIGHBOURHOOD = 8.0, 6.0, 8


@dataclass(frozen=True, eq=False)
class Record:
    """One measured curve in SI, in the order in which it was recorded.

    Attributes
    ----------
    name : str
    displacement : ndarray, shape (m,)
        Of the punch towards the solid, from any zero, in m.
    load : ndarray, shape (m,)
        In N, tension negative, from any zero.
    approach : ndarray of bool, shape (m,)
        Whether a point is of the approach.
    stiffness : float
        Of the cantilever in N/m; infinite where the displacement is prescribed.

    Examples
    --------
    >>> x = np.linspace(-1.0, 0.0, 30)
    >>> record = Record("a", x, np.where(x < -0.5, 0.0, -1.0), x < 1.0)
    >>> record.jump(True), record.jump(False)
    (15, None)
    """

    name: str
    displacement: Array
    load: Array
    approach: NDArray[np.bool_]
    stiffness: float = math.inf

    @property
    def position(self) -> Array:
        """Position of the base of the cantilever towards the solid, which the machine prescribes, in m."""
        return self.displacement + self.load / self.stiffness

    @property
    def noise(self) -> float:
        """Standard deviation of the load, as if neighbours had independent errors, in N."""
        errors = [np.diff(self.load[mask], 2) for mask in (self.approach, ~self.approach) if mask.sum() > 2]
        # The median of the size of a normal error is 0.6745 standard deviations; a second difference has sqrt(6).
        deviation = float(np.median(np.abs(np.concatenate(errors)))) / (0.6745 * math.sqrt(6.0))
        # A computed curve has none.
        return max(deviation, 1e-6 * float(np.ptp(self.load)))

    def only(self, branch: str) -> Record:
        """Return the approach or the retreat alone."""
        mask = self.approach if branch == "approach" else ~self.approach
        return replace(self, displacement=self.displacement[mask], load=self.load[mask], approach=self.approach[mask])

    def jump(self, approach: bool) -> int | None:
        """Return the number of the first point after the jump of the approach, or of the retreat; None without one."""
        where = np.flatnonzero(self.approach == approach)
        if len(where) < _FEWEST:
            return None
        # The surfaces snap together, which draws the punch, or part, which ends the tension.
        steps = np.diff(self.load[where]) * (-1.0 if approach else 1.0)
        largest = int(np.argmax(steps))
        around = np.abs(steps[max(largest - _NEIGHBOURHOOD, 0) : largest + _NEIGHBOURHOOD + 1])
        usual = float(np.median(around))
        is_jump = steps[largest] > max(_NOISE * math.sqrt(2.0) * self.noise, _USUAL * usual)
        return int(where[largest + 1]) if is_jump else None


def read_records(path: Path, stiffness: float | None = None, sensitivity: float | None = None) -> list[Record]:
    """Read the curves of a file.

    Parameters
    ----------
    path : Path
        A CSV file with the columns ``displacement [nm]`` and ``load [nN]``, or ``height [nm]`` and ``deflection [nm]``
        (or in V), in these or other units, and perhaps ``branch`` with the words approach and retreat; or a file that
        `afmformats` reads.
    stiffness : float, optional
        Of the cantilever in N/m.
    sensitivity : float, optional
        Deflection for a volt, in m/V.

    Raises
    ------
    ValueError
        One sentence with the file, the value and the remedy.
    """
    if path.suffix.lower() == ".csv":
        text = read_text(path, "the curve", LARGEST_TABLE)
        if not text.startswith("Force-Distance Curve"):
            return [_checked(_of_csv(path, text, stiffness, sensitivity), path)]
    return [_checked(record, path) for record in _of_afm_file(path, stiffness, sensitivity)]


def _of_csv(path: Path, text: str, stiffness: float | None, sensitivity: float | None) -> Record:
    try:
        table = pd.read_csv(io.StringIO(text), comment="#", skipinitialspace=True)
    except (pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        raise ValueError(
            f"{path}: the curve is not a CSV table ({str(error).strip()}); write one row per point"
        ) from None
    columns: dict[str, Any] = {}
    for heading in table.columns:
        name, unit = column_heading(str(heading), _COLUMNS, str(path))
        columns[name] = table[heading] if name == "branch" else _numbers(path, name, table[heading], unit, sensitivity)
    if "deflection" in columns:
        if stiffness is None:
            raise ValueError(f"{path}: a deflection needs the stiffness of the cantilever; give it with --stiffness")
        columns.setdefault("load", stiffness * columns["deflection"])
    if "height" in columns and "load" in columns and stiffness is not None:
        columns.setdefault("displacement", columns["height"] - columns["load"] / stiffness)
    if missing := [name for name in ("displacement", "load") if name not in columns]:
        raise ValueError(
            f"{path}: the column {missing[0]} is missing; a curve has displacement and load, "
            "or height and deflection with --stiffness"
        )
    displacement = columns["displacement"]
    approach = _approach(path, columns.get("branch"), displacement)
    return Record(path.name, displacement, columns["load"], approach, math.inf if stiffness is None else stiffness)


def _numbers(path: Path, name: str, column: pd.Series, unit: str | None, sensitivity: float | None) -> Array:
    numbers = pd.to_numeric(column, errors="coerce").to_numpy(float)
    if not np.isfinite(numbers).all():
        row = int(np.flatnonzero(~np.isfinite(numbers))[0])
        raise ValueError(
            f"{path}: {name} = {shown(str(column[row]))} in row {row + 1} below the names is not a finite number"
        )
    if unit is None:
        raise ValueError(f"{path}: the column {name} has no unit; write it as {name} [n{_COLUMNS[name]}]")
    try:
        if name == "deflection" and sensitivity is not None:
            return numbers * unit_factor(unit, "V") * sensitivity
        return numbers * unit_factor(unit, _COLUMNS[name])
    except NotAValue as error:
        hint = "; a deflection in volts needs --sensitivity" if name == "deflection" else ""
        raise ValueError(f"{path}: the column {name} {error}{hint}") from None


def _approach(path: Path, words: pd.Series | None, displacement: Array) -> NDArray[np.bool_]:
    """Whether each point is of the approach: by the words of the file, or until the displacement is largest."""
    if words is None:
        return np.arange(len(displacement)) <= int(np.argmax(displacement))
    stripped = words.astype(str).str.strip()
    if unknown := sorted(set(stripped) - set(_BRANCHES)):
        raise ValueError(f"{path}: branch = {shown(unknown[0])} is none of {' and '.join(_BRANCHES)}")
    return (stripped == "approach").to_numpy(bool)


def _of_afm_file(path: Path, stiffness: float | None, sensitivity: float | None) -> list[Record]:
    try:
        import afmformats
    except ImportError:
        raise ValueError(
            f"{path} is not a CSV file with the columns displacement and load; for files of instruments install "
            "pip install 'fscm-bench[afm]'"
        ) from None
    check_regular(path, path.stat(), LARGEST_TABLE)
    given = {"spring constant": stiffness, "sensitivity": sensitivity}
    try:
        curves = afmformats.load_data(path, meta_override={name: value for name, value in given.items() if value})
        return [_of_segments(f"{path.name}#{number}", curve) for number, curve in enumerate(curves, start=1)]
    # What a reader of many formats raises for a file that it does not know is not documented.
    except Exception as error:
        raise ValueError(f"{path}: afmformats cannot read forces in it ({type(error).__name__}: {error})") from None


def _of_segments(name: str, curve: Any) -> Record:
    stiffness = float(curve.metadata["spring constant"])
    force, height = (np.asarray(curve[column], float) for column in ("force", "height (measured)"))
    # A height grows away from the solid; the tip is where the base is, and the deflection.
    displacement = -(height + force / stiffness)
    usable = np.isfinite(force) & np.isfinite(height)
    approach = np.asarray(curve["segment"]) == 0
    return Record(name, displacement[usable], force[usable], approach[usable], stiffness)


def _checked(record: Record, path: Path) -> Record:
    if len(record.load) < _FEWEST:
        raise ValueError(f"{path}: {len(record.load)} points are fewer than {_FEWEST}; a fit needs more")
    if not (np.ptp(record.load) > 0.0 and np.ptp(record.displacement) > 0.0):
        raise ValueError(f"{path}: all loads, or all displacements, are equal; check the columns")
    return record
