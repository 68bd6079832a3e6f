"""Text of a file of grids."""

import json


def grid_text(models, reference="bradley", quantities=("pull_off_force",), **more):
    """One grid; `more` are its parameters and its tier."""
    table = {"id": "mine", "title": "Mine", "reference": reference, "models": models, "quantities": quantities} | more
    return "\n".join(["[[grid]]", *(f"{key} = {json.dumps(value)}" for key, value in table.items()), ""])
