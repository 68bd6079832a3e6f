"""Reader of measured curves: texts that programs and people export, and files of instruments.

Senses are those of the record itself, where it shows them (`comparisons.fitting.motion`).  Where it does not: a
displacement, or the height of a text, grows towards the solid, and the height of an instrument's file away from it; a
load is positive if pressed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from comparisons.data.input_files import LARGEST_TABLE, read_text
from comparisons.data.validation import shown
from comparisons.fitting.exported_text import APPROACH, REST, RETREAT, Cells, Export, export_of
from comparisons.fitting.motion import Phases, phases, senses
from comparisons.fitting.record import Record, Spot, checked
from comparisons.model import Array
from comparisons.problem.columns import number_of
from comparisons.problem.units import LARGEST_SIZE, NotAValue, unit_factor

#: Units of the signal of a photodiode.
SIGNALS = ("V", "A", "count")

#: Endings of texts that are read here; other files are read by afmformats, which also reads some texts.
_TEXTS = (".csv", ".txt", ".tsv", ".dat", ".asc")


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """Deflection of the cantilever for a signal of its photodiode.

    Attributes
    ----------
    value : float
        In m for a unit of the signal.
    signal : str
        Unit of the signal: "V", "A" or "count".
    """

    value: float
    signal: str = "V"


@dataclass(frozen=True, eq=False)
class Measured:
    """What a file says of one curve, in SI.

    Attributes
    ----------
    driver : str
        "height" of the base of the cantilever, or "displacement" of the punch.
    position, load : ndarray, shape (m,)
        The driver and the load, of any senses, in the order of the file.
    stiffness : float
        Of the cantilever in N/m, or infinite.
    towards : int
        1 if the driver grows towards the solid by convention, -1 if away from it.
    motions : list of str, optional
        Words of the file for the motion.
    remarks : list of str
    """

    driver: str
    position: Array
    load: Array
    stiffness: float
    towards: int
    motions: list[str] | None = None
    remarks: list[str] = field(default_factory=list)

    def record(self, name: str, source: str) -> Record:
        """Return the record; `ValueError` in one sentence if it cannot be used."""
        usable = np.isfinite(self.position) & np.isfinite(self.load)
        position, load = self.position[usable], self.load[usable]
        remarks = list(self.remarks)
        shown_senses = senses(position, load)
        towards, pressed = shown_senses.position or self.towards, shown_senses.load or 1
        if towards != self.towards:
            way = "away from" if towards < 0 else "towards"
            remarks.append(f"the {self.driver} was read as growing {way} the solid, as the record shows")
        if pressed < 0:
            remarks.append("the load was read with the other sign, as the record shows: it is positive if pressed")
        load = pressed * load
        compliance = load / self.stiffness
        base = towards * position + (compliance if self.driver == "displacement" else 0.0)
        try:
            moving = phases(base) if self.motions is None else _stated(base, np.array(self.motions)[usable])
        except ValueError as error:
            wrong = "; or the stiffness is not that of its cantilever" if self.driver == "displacement" else ""
            raise ValueError(f"{source}: it {error}{wrong if math.isfinite(self.stiffness) else ''}") from None
        remarks += [
            f"{count} points {when}, where the punch rests, were left out" for when, count in moving.rests.items()
        ]
        order = _in_time(base, moving)
        return checked(
            Record(name, (base - compliance)[order], load[order], moving.approach[order], self.stiffness, remarks),
            source,
        )


def _stated(base: Array, motions: NDArray[np.str_]) -> Phases:
    """The phases by the words of a file."""
    resting = int(np.sum(motions == REST))
    approach, retreat = motions == APPROACH, motions == RETREAT
    if approach.all() and resting == 0 and len(base):
        return phases(base)
    return Phases(approach, retreat, {"which the file names": resting} if resting else {})


def _in_time(base: Array, moving: Phases) -> NDArray[np.intp]:
    """Numbers of the points in the order of time: some files list a branch against its motion, or the retreat first."""
    order = []
    for branch, sense in ((moving.approach, 1.0), (moving.retreat, -1.0)):
        numbers = np.flatnonzero(branch)
        half = len(numbers) // 2
        if half and sense * (float(np.mean(base[numbers[-half:]])) - float(np.mean(base[numbers[:half]]))) < 0.0:
            numbers = numbers[::-1]
        order.append(numbers)
    return np.concatenate(order)


def read_records(
    path: Path, stiffness: float | None = None, sensitivity: float | Sensitivity | None = None
) -> list[Record]:
    """Read the curves of a file.

    Parameters
    ----------
    path : Path
        A text with the columns ``displacement [nm]`` and ``load [nN]``, or ``height [nm]`` and ``deflection [nm]``
        (or in V), in these or other units, and perhaps ``branch`` with the words approach and retreat; or a file that
        `afmformats` reads.
    stiffness : float, optional
        Of the cantilever in N/m.
    sensitivity : float or Sensitivity, optional
        Deflection for a signal, a number in m/V.

    Raises
    ------
    ValueError
        One sentence with the file, the value and the remedy.
    """
    return [curve.read() for curve in curves_in(path, path.name, stiffness, sensitivity)]


@dataclass(frozen=True)
class Curve:
    """A curve of a file, which is not read yet.

    Attributes
    ----------
    name : str
    read : callable
        Returns its record; raises `ValueError` with one sentence if it cannot be used.
    spot : Spot
        Where it was measured, if its file is a map.
    """

    name: str
    read: Callable[[], Record]
    spot: Spot = field(default_factory=Spot)


def curves_in(
    path: Path, name: str, stiffness: float | None = None, sensitivity: float | Sensitivity | None = None
) -> list[Curve]:
    """Return the curves of a file, which each may have a reason of its own why it cannot be used.

    Parameters
    ----------
    path : Path
    name : str
        Of the curve; those of a file of an instrument have ``#`` and a number after it.
    stiffness, sensitivity
        As of `read_records`.

    Raises
    ------
    ValueError
        As `read_records`, if no curve of the file can be read.
    """
    if isinstance(sensitivity, float | int):
        sensitivity = Sensitivity(float(sensitivity))
    source = str(path)
    if path.suffix.lower() in _TEXTS:
        text = read_text(path, "the curve", LARGEST_TABLE, or_western=True)
        if not _is_of_afmformats(text):
            return [Curve(name, lambda: _of_text(text, source, stiffness, sensitivity).record(name, source))]
    from comparisons.fitting.instrument_files import curves_of

    return [
        Curve(f"{name}#{number}", partial(_record, measured, f"{name}#{number}", source), spot)
        for number, (spot, measured) in enumerate(curves_of(path, stiffness, sensitivity), start=1)
    ]


def _record(measured: Callable[[], Measured], name: str, source: str) -> Record:
    return measured().record(name, source)


def _is_of_afmformats(text: str) -> bool:
    """Whether a text is of a form that afmformats reads: its own, two of instruments, or bare columns of NT-MDT."""
    first = next((line for line in text.splitlines() if line.strip()), "")
    if not first:
        return False
    return first.startswith(("Force-Distance Curve", "# afmformats", "Date\t")) or _are_numbers(first.split())


def _are_numbers(cells: Iterable[str]) -> bool:
    try:
        return all(number_of(cell.replace(",", ".", 1)) is not None for cell in cells)
    except NotAValue:
        return False


def _of_text(text: str, source: str, stiffness: float | None, sensitivity: Sensitivity | None) -> Measured:
    export = export_of(text, source)
    stiffness = stiffness if stiffness is not None else _positive(export.stated.get("springConstant"))
    if sensitivity is None and (slope := _positive(export.stated.get("sensitivity"))):
        sensitivity = Sensitivity(slope)
    not_needed = "deflection" if "load" in export.columns else ""
    values = {
        name: _numbers(export, name, cells, sensitivity) for name, cells in export.columns.items() if name != not_needed
    }
    load = values.get("load")
    if load is None and "deflection" in values:
        if stiffness is None:
            raise ValueError(f"{source}: a deflection needs the stiffness of the cantilever; give it with --stiffness")
        load = stiffness * values["deflection"]
    if load is None:
        raise _missing(source, "load")
    if "displacement" in values:
        driver = "displacement"
    elif "height" in values:
        driver = "height"
        if stiffness is None:
            raise ValueError(f"{source}: a height needs the stiffness of the cantilever; give it with --stiffness")
    else:
        raise _missing(source, "displacement")
    return Measured(
        driver, values[driver], load, stiffness or math.inf, 1, export.motions, list(export.remarks)
    )  # fmt: skip


def _missing(source: str, column: str) -> ValueError:
    return ValueError(
        f"{source}: the column {column} is missing; a curve has displacement and load, "
        "or height and deflection with --stiffness"
    )


def _positive(text: str | None) -> float | None:
    try:
        value = number_of(text) if text else 0.0
    except NotAValue:
        return None
    return value if value > 0.0 else None


def _numbers(export: Export, column: str, cells: Cells, sensitivity: Sensitivity | None) -> Array:
    """A column in SI."""
    target = "N" if column == "load" else "m"
    if cells.unit is None:
        raise ValueError(
            f"{export.location}: the column {cells.name} has no unit; write it as {cells.name} [n{target}]"
        )
    factor = _factor(export, cells, target, sensitivity if column == "deflection" else None)
    values = []
    for location, cell in zip(export.locations, cells.values, strict=True):
        try:
            value = number_of(cell) * factor
        except NotAValue as error:
            raise ValueError(f"{location}: {cells.name} = {shown(cell)} {error}") from None
        if not abs(value) <= LARGEST_SIZE:
            raise ValueError(
                f"{location}: {cells.name} = {shown(cell)} is above {LARGEST_SIZE:g} {target}; check the number"
            )
        values.append(value)
    return np.array(values)


def _factor(export: Export, cells: Cells, target: str, sensitivity: Sensitivity | None) -> float:
    unit = str(cells.unit)
    try:
        return unit_factor(unit, target)
    except NotAValue as error:
        refusal = error
    for signal in SIGNALS:
        try:
            factor = unit_factor(unit, signal)
        except NotAValue:
            continue
        if sensitivity is None:
            raise ValueError(
                f"{export.location}: the column {cells.name} is in {unit}: state the deflection for it, as "
                f"--sensitivity '50 nm/{signal}'"
            )
        if sensitivity.signal != signal:
            raise ValueError(
                f"{export.location}: the column {cells.name} is in {unit}, and the sensitivity for a signal in "
                f"{sensitivity.signal}; state it as --sensitivity '50 nm/{signal}'"
            )
        return factor * sensitivity.value
    raise ValueError(f"{export.location}: the column {cells.name} {refusal}; write one of {target}")
