"""Errors of the closed forms over shape, gradient and Tabor number: the tables of docs/which_model.md.

python docs/examples/model_choice.py
"""

import numpy as np

import fscm
from comparisons import create

SHAPES, GRADIENTS = (1, 1.5, 2, 3, 5), (0, 0.4, 0.8)
FINE = np.geomspace(0.01, 10, 301)
COARSE = np.geomspace(0.01, 10, 10)


def errors(name, n, k, mu):
    """Relative errors of the pull-off force against the atlas."""
    model = create(name)
    values = [model.evaluate(fscm.Problem(n=n, k=k, mu=float(one)), "pull_off_force").value for one in mu]
    return np.array(values) / fscm.atlas(n, k, mu, "pull_off_force").value - 1


def below(name, n, k, limit):
    """The Tabor number up to which the error is within a limit."""
    beyond = np.flatnonzero(np.abs(errors(name, n, k, FINE)) > limit)
    return "10" if not beyond.size else "none" if beyond[0] == 0 else f"{FINE[beyond[0] - 1]:.2g}"


def above(name, n, k, limit):
    """The Tabor number from which on the error is within a limit."""
    beyond = np.flatnonzero(np.abs(errors(name, n, k, FINE)) > limit)
    return "0.01" if not beyond.size else "none" if beyond[-1] == len(FINE) - 1 else f"{FINE[beyond[-1] + 1]:.2g}"


print("| n | k | Bradley, 1 % up to mu = | Bradley, 5 % up to | JKR, 5 % from mu = | JKR, 1 % from |")
print("|---|---|---|---|---|---|")
for n in SHAPES:
    for k in GRADIENTS:
        limits = [below("bradley", n, k, 0.01), below("bradley", n, k, 0.05)]
        limits += [above("jkr", n, k, 0.05), above("jkr", n, k, 0.01)]
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
