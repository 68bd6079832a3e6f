"""Texts of a file of grids and of a problem file."""

import json

#: A sphere of 1 um on a soft solid.
PAD = """
solid = {kind = "homogeneous", E = "2 MPa", nu = 0.4}
punch = {kind = "sphere", R = "1 um"}
law = {kind = "lennard-jones-9-3", work_of_adhesion = "50 mJ/m^2", z0 = "0.4 nm"}
"""


def grid_text(models, reference="bradley", quantities=("pull_off_force",), **more):
    """One grid; `more` are its parameters, its tier, or its problem file with the values of `vary`."""
    table = {"id": "mine", "title": "Mine", "reference": reference, "models": models, "quantities": quantities} | more
    return "\n".join(["[[grid]]", *(f"{key} = {_written(value)}" for key, value in table.items()), ""])


def _written(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{key}" = {_written(inner)}' for key, inner in value.items()) + "}"
    return json.dumps(value)
