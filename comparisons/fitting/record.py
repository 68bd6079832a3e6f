"""A measured force-displacement curve: how it is read, and where it jumps."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.data.input_files import LARGEST_TABLE, check_regular, read_text
from comparisons.data.validation import shown
from comparisons.model import Array
from comparisons.problem.columns import Columns, columns_of, factor_of, number_of
from comparisons.problem.units import LARGEST_SIZE, NotAValue

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
    records = []
    for record in records_or_refusals(path, path.name, stiffness, sensitivity).values():
        if isinstance(record, ValueError):
            raise record
        records.append(record)
    return records


def records_or_refusals(
    path: Path, name: str, stiffness: float | None = None, sensitivity: float | None = None
) -> dict[str, Record | ValueError]:
    """Return each curve of a file as `read_records`, or why it cannot be used, by its name.

    Parameters
    ----------
    path : Path
    name : str
        Of the curve; those of a file of several curves have ``#`` and a number after it.
    stiffness, sensitivity : float, optional
        As of `read_records`.

    Raises
    ------
    ValueError
        As `read_records`, if no curve of the file can be read.
    """
    if path.suffix.lower() == ".csv":
        text = read_text(path, "the curve", LARGEST_TABLE)
        if not text.startswith("Force-Distance Curve"):
            return {name: checked(_of_csv(path, text, name, stiffness, sensitivity), str(path))}
    return _of_afm_file(path, name, stiffness, sensitivity)


def _of_csv(path: Path, text: str, name: str, stiffness: float | None, sensitivity: float | None) -> Record:
    written = columns_of(text, str(path), _COLUMNS)
    columns = {column: _numbers(written, column, sensitivity) for column in written.units if column != "branch"}
    if "deflection" in columns:
        if stiffness is None:
            raise ValueError(f"{path}: a deflection needs the stiffness of the cantilever; give it with --stiffness")
        columns.setdefault("load", stiffness * columns["deflection"])
    if "height" in columns and "load" in columns and stiffness is not None:
        columns.setdefault("displacement", columns["height"] - columns["load"] / stiffness)
    if missing := [column for column in ("displacement", "load") if column not in columns]:
        raise ValueError(
            f"{path}: the column {missing[0]} is missing; a curve has displacement and load, "
            "or height and deflection with --stiffness"
        )
    displacement = columns["displacement"]
    approach = _approach(written, displacement)
    return Record(name, displacement, columns["load"], approach, math.inf if stiffness is None else stiffness)


def _numbers(written: Columns, name: str, sensitivity: float | None) -> Array:
    """A column in SI."""
    unit, target = written.units[name], _COLUMNS[name]
    if unit is None:
        raise ValueError(f"{written.place}: the column {name} has no unit; write it as {name} [n{target}]")
    if name == "deflection" and sensitivity is not None:
        factor = sensitivity * factor_of(written, name, unit, "V")
    else:
        hint = "; a deflection in volts needs --sensitivity" if name == "deflection" else ""
        factor = factor_of(written, name, unit, target, hint)
    values = []
    for place, cell in zip(written.places, written.cells[name], strict=True):
        try:
            value = number_of(cell) * factor
        except NotAValue as error:
            raise ValueError(f"{place}: {name} = {shown(cell)} {error}") from None
        if not abs(value) <= LARGEST_SIZE:
            raise ValueError(f"{place}: {name} = {shown(cell)} is above {LARGEST_SIZE:g} {target}; check the number")
        values.append(value)
    return np.array(values)


def _approach(written: Columns, displacement: Array) -> NDArray[np.bool_]:
    """Whether each point is of the approach: by the words of the file, or until the displacement is largest."""
    if "branch" not in written.cells:
        return np.arange(len(displacement)) <= (int(np.argmax(displacement)) if len(displacement) else 0)
    words = written.cells["branch"]
    for place, word in zip(written.places, words, strict=True):
        if word not in _BRANCHES:
            raise ValueError(f"{place}: branch = {shown(word)} is none of {' and '.join(_BRANCHES)}")
    return np.array([word == "approach" for word in words], bool)


def _of_afm_file(
    path: Path, name: str, stiffness: float | None, sensitivity: float | None
) -> dict[str, Record | ValueError]:
    try:
        import afmformats
    except ImportError:
        raise ValueError(
            f"{path} is not a CSV file with the columns displacement and load; for files of instruments install "
            "pip install 'fscm-bench[afm]'"
        ) from None
    given = {"spring constant": stiffness, "sensitivity": sensitivity}
    # What a reader of many formats raises for a file that it does not know is not documented; some of its own
    # exceptions are none of `Exception`.
    failures = (Exception, afmformats.errors.AFMFileFormatError, afmformats.errors.MissingMetaDataError)
    try:
        check_regular(path, path.stat(), LARGEST_TABLE)
        with warnings.catch_warnings(action="ignore"):
            curves = afmformats.load_data(path, meta_override={name: value for name, value in given.items() if value})
    except failures as error:
        raise _not_read(path, error) from None
    records: dict[str, Record | ValueError] = {}
    for number, curve in enumerate(curves, start=1):
        name_of_curve = f"{name}#{number}"
        try:
            record = _of_segments(name_of_curve, curve)
        except failures as error:
            records[name_of_curve] = _not_read(path, error)
            continue
        try:
            records[name_of_curve] = checked(record, str(path))
        except ValueError as refusal:
            records[name_of_curve] = refusal
    return records


def _not_read(path: Path, error: BaseException) -> ValueError:
    return ValueError(f"{path}: afmformats cannot read forces in it ({type(error).__name__}: {error})")


def _of_segments(name: str, curve: Any) -> Record:
    stiffness = float(curve.metadata["spring constant"])
    force, height = (np.asarray(curve[column], float) for column in ("force", "height (measured)"))
    # A height grows away from the solid; the tip is where the base is, and the deflection.
    displacement = -(height + force / stiffness)
    usable = np.isfinite(force) & np.isfinite(height)
    approach = np.asarray(curve["segment"]) == 0
    return Record(name, displacement[usable], force[usable], approach[usable], stiffness)


def checked(record: Record, source: str) -> Record:
    """Return a record; `ValueError` if no values can be fitted to it, in one sentence that begins with the source."""
    if len(record.load) < _FEWEST:
        raise ValueError(f"{source}: {len(record.load)} points are fewer than {_FEWEST}; a fit needs more")
    for name, values, unit in (("loads", record.load, "N"), ("displacements", record.displacement, "m")):
        span = float(np.ptp(values))
        if span == 0.0:
            raise ValueError(f"{source}: all {name} are equal; check the columns")
        if not 1.0 / LARGEST_SIZE <= span <= LARGEST_SIZE:
            raise ValueError(
                f"{source}: the {name} have a range of {span:.3g} {unit}, outside {1.0 / LARGEST_SIZE:g} to "
                f"{LARGEST_SIZE:g} {unit}; check the units of the columns"
            )
    return record
