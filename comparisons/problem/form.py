"""Values of a section of a problem file in SI, checked by the table of kinds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from comparisons.data.validation import shown
from comparisons.problem.kinds import KINDS, Form, is_admissible
from comparisons.problem.source import Source
from comparisons.problem.uncertain import Uncertainty, is_uncertain, uncertain_in_si
from comparisons.problem.units import NotAValue, in_si

__all__ = ["values_in_si"]


def values_in_si(
    section: str, table: Mapping[str, Any], source: Source
) -> tuple[dict[str, Any], dict[str, Uncertainty]]:
    """Return the values of a section in SI, names of files as they are; and what is uncertain of them.

    Parameters
    ----------
    section : str
    table : mapping
        As in the file, of a form that fits the schema.
    source : Source

    Raises
    ------
    ValueError
        One sentence with file, line, value and remedy.
    """
    values: dict[str, Any] = {}
    uncertain: dict[str, Uncertainty] = {}
    for key, form in KINDS[section][table["kind"]].keys.items():
        if key not in table:
            continue
        written = table[key]
        # The shape index stands before Q in the table of kinds.
        power = values["n"] - 1.0 if form.get("unit") == "m^(n-1)" else 1.0
        try:
            if form["type"] == "string":
                values[key] = written
            elif form["type"] == "array":
                values[key] = tuple(_value(entry, form["items"], power)[0] for entry in written)
            else:
                values[key], spread = _value(written, form, power)
                uncertain |= {key: spread} if spread else {}
        except NotAValue as error:
            sentence = f"{section}.{key} = {shown(written)} {error}; it must be {form['description']}"
            raise source.refusal(sentence, section, key) from None
    return values, uncertain


def _value(written: object, form: Form, power: float) -> tuple[float, Uncertainty | None]:
    """A value in SI, with its uncertainty if it has one; `NotAValue` if it is not admissible."""
    unit = form.get("unit", "").removesuffix("^(n-1)")
    if not is_uncertain(written):
        value, spread = in_si(written, unit, power), None
        ends = {value}
    else:
        if not form.get("uncertain", True):
            raise NotAValue("has an uncertainty, which is not admissible here")
        value, spread = uncertain_in_si(str(written), unit, power)
        low, high = spread.limits(value)
        ends = {low, high} if spread.is_interval else {value}
        if "exclusiveMinimum" in form:
            # A standard deviation may reach 0 where 0 is admissible.
            ends.add(low)
    if not all(is_admissible(form, end) for end in ends):
        raise NotAValue("reaches outside its range" if spread else "is outside its range")
    return value, spread
