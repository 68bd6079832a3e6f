"""How wrong is JKR, and how sure are we?  The relative error of a model against the Tabor number, with its band.

python docs/examples/errors_of_a_model.py
"""

import pandas as pd

from comparisons.output.tables import relative_error
from comparisons.registry import create
from comparisons.runs.cases import Case
from comparisons.runs.tables import frame
from comparisons.runs.tasks import evaluate

models = [create("fscm"), create("jkr"), create("md-improved")]
cases = [Case(n=2, k=0.4, mu=mu) for mu in (0.1, 0.3, 1.0, 3.0)]
rows = frame(evaluate(model, "pull_off_force", case) for case in cases for model in models)

kappa = relative_error(rows, reference="fscm")
with pd.option_context("display.width", 120):
    print(kappa[["model", "mu", "value", "reference_value", "u_reference", "kappa", "u_kappa"]].to_string(index=False))
