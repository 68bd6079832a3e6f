"""The registry of quantities: numbers, curves and fields, one row each."""

from __future__ import annotations

from comparisons.quantities.quantity import Axis, CurveQuantity, Kind, Points, ScalarQuantity

__all__ = ["ALL_QUANTITIES", "CURVES", "QUANTITIES", "CurveQuantity", "Kind", "Points", "ScalarQuantity", "title_of"]

_DISPLACEMENT = Axis("displacement", "δ", "displacement", "displacement", "δ / z₀", r"\delta / z_0")
_RADIUS = Axis("radius", "r", "radius", "radius", "r / (Q z₀)^(1/n)", r"r / (Q z_0)^{1/n}")
_LOAD = Axis(
    "load",
    "P",
    "load",
    "load",
    "P / (π Q^(2/n) Δγ z₀^(2/n−1))",
    r"P / (\pi Q^{2/n} \Delta\gamma z_0^{2/n-1})",
    "tension negative",
)
_PRESSURE = Axis(
    "pressure", "p", "traction", "pressure at pull-off", "p z₀ / Δγ", r"p z_0 / \Delta\gamma", "tension negative"
)
_GAP = Axis("gap", "H", "gap", "gap at pull-off", "H / z₀", "H / z_0")

_SCALARS = (
    ("pull_off_force", "-P_c", "pull-off force", "-min P along the equilibrium path", "load"),
    ("pull_off_displacement", "delta_c", "pull-off displacement", "displacement where P is smallest", "displacement"),
    (
        "jump_in_displacement",
        "delta_in",
        "jump-in displacement",
        "fold where approach jumps into contact",
        "displacement",
    ),
    ("jump_in_gap", "H0_in", "jump-in gap", "central gap at the jump-in fold", "gap"),
    (
        "jump_out_displacement",
        "delta_out",
        "jump-out displacement",
        "fold where retreat jumps out of contact",
        "displacement",
    ),
    ("jump_out_gap", "H0_out", "jump-out gap", "central gap at the jump-out fold", "gap"),
    (
        "zero_load_displacement",
        "delta_0",
        "zero-load displacement",
        "displacement in contact where P = 0",
        "displacement",
    ),
    ("hysteresis_energy", "W_hys", "hysteresis energy", "lost in one cycle of displacement control", "energy"),
    (
        "critical_tabor_number",
        "mu_crit",
        "critical Tabor number",
        "jumps and hysteresis exist above it; mu is ignored",
        "number",
    ),
)

#: Every scalar, by name.
QUANTITIES = {row[0]: ScalarQuantity(*row) for row in _SCALARS}

_CURVES = (
    CurveQuantity(
        "force_curve",
        "P(delta)",
        "force-displacement curve",
        "equilibrium path, from far away into contact",
        Kind.CURVE,
        _DISPLACEMENT,
        _LOAD,
        "The whole equilibrium path, its unstable part included, from far away (left) into contact. A "
        "machine that controls the displacement jumps where the path turns back. Tension is negative.",
    ),
    CurveQuantity(
        "pull_off_pressure",
        "p(r)",
        "pressure at pull-off",
        "pressure over the radius where P is smallest",
        Kind.FIELD,
        _RADIUS,
        _PRESSURE,
        "The pressure where the load is smallest, out to a gap of 10 z₀; tension is negative.",
    ),
    CurveQuantity(
        "pull_off_gap",
        "H(r)",
        "gap at pull-off",
        "gap over the radius where P is smallest",
        Kind.FIELD,
        _RADIUS,
        _GAP,
        "The gap where the load is smallest, out to 10 z₀. Zero is the equilibrium distance of two flat "
        "surfaces, where the pressure is zero.",
    ),
)

#: Curves and fields, by name.
CURVES = {row.name: row for row in _CURVES}

#: Every scalar and every curve, by name.
ALL_QUANTITIES: dict[str, ScalarQuantity | CurveQuantity] = {**QUANTITIES, **CURVES}


def title_of(quantity: str) -> str:
    """Return the name of a quantity in a sentence; one that is not in the registry keeps its words.

    Examples
    --------
    >>> title_of("pull_off_force"), title_of("force_curve"), title_of("work_of_adhesion")
    ('pull-off force', 'force-displacement curve', 'work of adhesion')
    """
    row = ALL_QUANTITIES.get(quantity)
    return row.title if row else quantity.replace("_", " ")
