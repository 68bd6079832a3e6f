"""The names that most users need, for the first page of the API reference."""

from __future__ import annotations

#: Names by what they are for, in the order of a computation.
NAMES = {
    "Pose a problem in units, from texts such as 2 GPa": ["comparisons.Problem"],
    "Pose a problem in plain numbers": ["fscm.Problem", "fem_reference.Problem"],
    "Solids": ["fscm.Homogeneous", "fscm.PowerLaw", "fscm.Coating", "fscm.Layers", "fscm.TabulatedModulus"],
    "Punches": ["fscm.Sphere", "fscm.Cone", "fscm.Ball", "fscm.PowerPunch", "fscm.MeasuredPunch"],
    "Laws": ["fscm.LennardJones", "fscm.Mie", "fscm.TabulatedLaw"],
    "Compute a force, a displacement or an energy with its bound": ["fscm.solve", "fem_reference.solve"],
    "Compute a force curve, and the surface at an event": ["fscm.trace", "fscm.profile"],
    "Interpolate in microseconds": ["fscm.atlas"],
    "Evaluate a model, its curve, compare models": [
        "comparisons.evaluate",
        "comparisons.curve",
        "comparisons.compare",
    ],
    "Derivatives and uncertainty": ["comparisons.sensitivity"],
    "Fit measured curves": ["comparisons.fit"],
}


def table() -> str:
    """Return the table in reStructuredText, with a link to each name."""
    lines = [".. list-table::", "   :header-rows: 1", "   :widths: 40 60", "", "   * - to", "     - use"]
    for purpose, names in NAMES.items():
        links = ", ".join(f":py:obj:`{name}`" for name in names)
        lines += [f"   * - {purpose}", f"     - {links}"]
    return "\n".join([*lines, "", ""])
