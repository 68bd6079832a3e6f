"""Curves of the files of instruments, by afmformats."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.data.input_files import LARGEST_ROWS, check_regular
from comparisons.fitting.reading import Measured, Sensitivity
from comparisons.fitting.record import Spot

__all__ = ["curves_of"]

#: Metadata that a user may state, by the name of afmformats.
_OPTIONS = {"spring constant": "--stiffness", "sensitivity": "--sensitivity"}
#: Names of afmformats for where a curve was measured, in the order of `Spot`.
_SPOT = ("position x", "position y", "grid index x", "grid index y")
#: What is exported by this maker's program is in nA, and its sensitivity is shown as one in nm/V.
_NANOAMPERE = "NT-MDT"


def curves_of(
    path: Path, stiffness: float | None, sensitivity: Sensitivity | None
) -> Iterator[tuple[Spot, Callable[[], Measured]]]:
    """Return where each curve of a file was measured, and functions that read them.

    Raises
    ------
    ValueError
        One sentence, if the file cannot be read; by the functions, if a curve cannot.
    """
    try:
        import afmformats
    except ImportError:
        raise ValueError(
            f"{path} is no text with the columns displacement and load; for files of instruments install "
            "pip install 'fscm-bench[afm]'"
        ) from None
    # What a reader of many formats raises for a file that it does not know is not documented; some of its own
    # exceptions are none of `Exception`.
    failures = (Exception, afmformats.errors.AFMFileFormatError, afmformats.errors.MissingMetaDataError)
    given = {"spring constant": stiffness, "sensitivity": None if sensitivity is None else sensitivity.value}

    def guarded(read: Callable[[], Any]) -> Any:
        try:
            with warnings.catch_warnings(action="ignore"), _silent("afmformats"):
                return read()
        except ValueError as error:
            raise (error if str(error).startswith(str(path)) else _not_read(path, error)) from None
        except failures as error:
            raise _not_read(path, error) from None

    def load(override: dict[str, float | None]) -> Any:
        try:
            return afmformats.load_data(path, meta_override=override)
        except afmformats.errors.MissingMetaDataError as error:
            wanted = {key: given.get(key) for key in error.meta_keys}
            if unknown := [key for key, value in wanted.items() if value is None]:
                raise _not_stated(path, unknown) from None
            if wanted.keys() <= override.keys():
                raise
            return load(override | wanted)

    def measured(curve: Any) -> Measured:
        return _of_segments(path, curve, given, sensitivity)

    try:
        check_regular(path, path.stat(), LARGEST_ROWS)
    except OSError as error:
        raise _not_read(path, error) from None
    curves = guarded(lambda: list(load({})))
    if not curves:
        raise ValueError(f"{path} has no curve of force and distance")
    if all("enum" in curve.metadata for curve in curves):
        # The groups of an HDF5 file come in the order of their names as words: 1, 10, 2.
        curves.sort(key=lambda curve: int(curve.metadata["enum"]))
    for curve in curves:
        try:
            spot = guarded(partial(_spot, curve.metadata))
        except ValueError:
            # The curve is good without.
            spot = Spot()
        yield spot, partial(guarded, partial(measured, curve))


def _spot(metadata: Any) -> Spot:
    # A value is computed when it is read by its key.
    known = {name: metadata[name] for name in _SPOT if name in metadata}
    x, y, column, row = map(known.get, _SPOT)
    x, y = (None if number is None or not np.isfinite(number) else float(number) for number in (x, y))
    return Spot(x, y, None if column is None else int(column), None if row is None else int(row))


@contextmanager
def _silent(logger: str) -> Iterator[None]:
    """Without what a library logs of an exception that becomes one sentence here."""
    of_library = logging.getLogger(logger)
    before = of_library.level
    of_library.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        of_library.setLevel(before)


def _not_stated(path: Path, keys: list[str]) -> ValueError:
    options = [f"{_OPTIONS[key]}" for key in keys if key in _OPTIONS]
    remedy = f"; state it with {' and '.join(options)}" if options else "; export the curve as text"
    return ValueError(f"{path} does not state the {' and the '.join(keys)} of the cantilever{remedy}")


def _not_read(path: Path, error: BaseException) -> ValueError:
    return ValueError(
        f"{path}: afmformats cannot read forces in it ({type(error).__name__}: {error}); export the curve as text, "
        "with the columns height [nm] and deflection [nm]"
    )


def _of_segments(path: Path, curve: Any, given: dict[str, float | None], sensitivity: Sensitivity | None) -> Measured:
    metadata = curve.metadata
    of_file = {key: float(metadata[key]) for key in _OPTIONS if key in metadata and np.isfinite(metadata[key])}
    if "spring constant" not in of_file and given["spring constant"] is None:
        raise _not_stated(path, ["spring constant"])
    remarks, factor = [], 1.0
    for key, option in _OPTIONS.items():
        value = given[key]
        if value is not None and key in of_file and value != of_file[key]:
            # The force of the file is the signal times its own constants.
            factor *= value / of_file[key]
            remarks.append(f"{option} was taken in place of the {key} of the file, {of_file[key]:.4g}")
    if (
        str(metadata.get("format", "")).startswith(_NANOAMPERE)
        and sensitivity is not None
        and sensitivity.signal == "V"
    ):
        factor *= 1e9
        remarks.append("the sensitivity was taken for a signal in nA, as this maker's program shows it")
    stiffness = given["spring constant"] or of_file["spring constant"]
    height = next((name for name in ("height (measured)", "height (piezo)") if name in curve), "height (measured)")
    position = np.asarray(curve[height], float)
    return Measured("height", position, factor * np.asarray(curve["force"], float), stiffness, -1, None, remarks)
