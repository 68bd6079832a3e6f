"""How wrong is JKR, and how sure are we?  The relative error of a model against the Tabor number, with its band.

python docs/examples/errors_of_a_model.py
"""

import pandas as pd

from comparisons import Case, errors

cases = [Case(n=2, k=0.4, mu=mu) for mu in (0.1, 0.3, 1.0, 3.0)]
kappa = errors(["jkr", "md-improved"], cases, quantity="pull_off_force", reference="fscm")
with pd.option_context("display.width", 120):
    print(kappa[["model", "mu", "value", "reference_value", "u_reference", "kappa", "u_kappa"]].to_string(index=False))
