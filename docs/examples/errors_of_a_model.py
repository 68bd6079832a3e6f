"""Relative errors of two models over the Tabor number, with the numerical uncertainty of each error.

python docs/examples/errors_of_a_model.py
"""

from comparisons import Problem, errors

cases = [Problem.dimensionless(n=2, k=0.4, mu=mu) for mu in (0.1, 0.3, 1.0, 3.0)]
table = errors(["jkr", "md-improved"], cases, quantity="pull_off_force", reference="fscm")

columns = ["model", "mu", "value", "reference_value", "u_reference", "kappa", "u_kappa"]
print(table[columns].to_string(index=False))
