"""
Errors of the closed forms
==========================

Relative error of the pull-off force of five models. The reference is the atlas, whose bound is below a millionth here.
"""

import matplotlib.pyplot as plt
import numpy as np

from comparisons import Problem, errors

models = ["bradley", "dmt", "jkr", "md-original", "md-improved"]
cases = [Problem.dimensionless(n=2, k=0.4, mu=mu) for mu in np.geomspace(0.01, 10, 25)]
table = errors(models, cases, reference="atlas")
figure, axes = plt.subplots(layout="constrained")
for name, rows in table.groupby("model", sort=False):
    axes.semilogx(rows["mu"], 100 * rows["kappa"], label=name)
axes.axhline(0, color="0.6", lw=0.8)
axes.set(xlabel="Tabor number", ylabel="relative error, %", title="Pull-off force, n = 2, k = 0.4", ylim=(-18, 18))
axes.legend(frameon=False)
plt.show()
