"""Errors of the closed forms over shape, gradient and Tabor number: the tables of docs/which_model.md.

python docs/examples/model_choice.py
"""

from functools import cache

import numpy as np

import fscm
from comparisons import create

SHAPES, GRADIENTS = (1, 1.5, 2, 3, 5), (0, 0.4, 0.8)
FINE = tuple(np.geomspace(0.01, 10, 61))
COARSE = tuple(np.geomspace(0.01, 10, 10))


@cache
def errors(name, n, k, mu):
    """Relative errors of the pull-off force against the atlas."""
    model = create(name)
    values = [model.evaluate(fscm.Problem(n=n, k=k, mu=float(one)), "pull_off_force").value for one in mu]
    return np.array(values) / fscm.atlas(n, k, mu, "pull_off_force").value - 1


def crossing(name, n, k, limit, *, first):
    """The Tabor number where the error first, or last, passes a limit; an end of the range if it never does."""
    excess = np.abs(errors(name, n, k, FINE)) - limit
    crossings = np.flatnonzero(np.diff(excess > 0))
    if not crossings.size:
        return "10" if first else "0.01"
    i = crossings[0 if first else -1]
    mu = np.exp(np.interp(0, sorted(excess[i : i + 2]), np.log(FINE[i : i + 2])[:: 1 if excess[i] < 0 else -1]))
    return f"{mu:.2g}"


print("| n | k | Bradley, 1 % up to mu = | Bradley, 5 % up to | JKR, 5 % from mu = | JKR, 1 % from |")
print("|---|---|---|---|---|---|")
for n in SHAPES:
    for k in GRADIENTS:
        limits = [crossing("bradley", n, k, limit, first=True) for limit in (0.01, 0.05)]
        limits += [crossing("jkr", n, k, limit, first=False) for limit in (0.05, 0.01)]
        print(f"| {n} | {k} | {' | '.join(limits)} |")

print()
print("| n | k | md-improved | md-original | double-hertz-n-k |")
print("|---|---|---|---|---|")
for n in SHAPES:
    for k in GRADIENTS:
        cells = []
        for name in ("md-improved", "md-original", "double-hertz-n-k"):
            kappa = errors(name, n, k, COARSE)
            worst = int(np.argmax(np.abs(kappa)))
            cells.append(f"{100 * kappa[worst]:+.1f} % at {COARSE[worst]:.2g}")
        print(f"| {n} | {k} | {' | '.join(cells)} |")
