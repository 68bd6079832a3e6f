"""Description of a problem as text: the objects of JSON in the template `text.jinja`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from comparisons.description.equivalent_ball import PARABOLOID
from comparisons.description.shared_errors import direction
from comparisons.numerics.number_text import SHORT_PERCENT, percent_text
from comparisons.problem import Problem
from comparisons.problem.equivalent_solid import LARGEST_DEVIATION
from comparisons.problem.units import si_text

Json = dict[str, Any]

#: Last digit of the force of a model, relative to it.
_LAST = 1e-6

#: Share of a contribution above which a change that it lacks is stated.
_COMPARABLE = 0.1


def description_text(
    problem: Problem, overview: Json, equivalent: Json | None, changes: Sequence[Json], stated: Json | None
) -> str:
    """Return the text of a description.

    Parameters
    ----------
    problem : Problem
    overview, equivalent, changes, stated
        As `overview`, `equivalent_power_law`, `profile_sensitivity` and `uncertainty` of this package return them.
    """
    environment = Environment(
        loader=PackageLoader("comparisons", "description"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"ends": _ends, "padded": _padded, "percent": _percent, "rounded": _rounded, "si": _si}
    environment.filters |= {"short_si": _short_si, "direction": direction}
    return environment.get_template("text.jinja").render(
        problem=problem,
        overview=overview,
        equivalent=equivalent,
        changes=changes,
        stated=stated,
        largest_deviation=LARGEST_DEVIATION,
        measures=_measures(overview["assumptions"]),
        shape_counts=_shape_counts(problem, overview["assumptions"], stated),
        written=[spread.written.strip() for spread in problem.uncertain.values()],
    )


#: Slopes that are large at every edge of a soft contact: the error of the assumption that each stands for.
_STANDS_FOR = {"surface_slope": "strain", "gap_slope": "derjaguin"}


def _measures(assumed: Json | None) -> list[Json]:
    """The measures of a contact, without those whose effect on the force is known."""
    if assumed is None:
        return []
    unknown = [key for key, name in _STANDS_FOR.items() if assumed[name]["error"] is None]
    return [row for row in assumed["measures"] if row["key"] not in _STANDS_FOR or row["key"] in unknown]


def _shape_counts(problem: Problem, assumed: Json | None, stated: Json | None) -> bool:
    """Whether the range of the law changes the force by the error of the paraboloid as much as by what is stated.

    The error of the paraboloid of a stiff solid is proportional to the range.
    """
    if problem.punch.kind != PARABOLOID or not assumed or not stated or stated["status"] != "ok":
        return False
    error, row = (
        assumed["geometry"]["error"],
        next((row for row in stated["parameters"] if row["parameter"] == "law.z0"), None),
    )
    if error is None or row is None or row["contribution"] is None or stated["quantity"] != "pull_off_force":
        return False
    size = problem.uncertain["law.z0"].size / row["value"]
    return bool(abs(error * stated["value"]) * size > _COMPARABLE * row["contribution"])


def _padded(text: str, column: Iterable[str]) -> str:
    """A text with the width of its column."""
    return text.ljust(max(map(len, column)))


def _percent(row: Mapping[str, float]) -> str:
    if row["error"] == row["u_num"] == 0.0:
        return "0 %"
    return f"{percent_text(row['error'], row['u_num'], SHORT_PERCENT)} %"


def _si(row: Mapping[str, Any]) -> str:
    return si_text(row["value"], row["u_num"], row["unit"])


def _short_si(row: Mapping[str, Any]) -> str:
    return si_text(row["value"], row["u_num"], row["unit"], _LAST * abs(row["value"]))


def _rounded(value: float, unit: str, digits: int = 3) -> str:
    return si_text(float(f"{value:.{digits}g}"), 0.0, unit)


def _ends(ends: Sequence[float], unit: str) -> str:
    return " to ".join(_rounded(end, unit, 5) for end in ends)
