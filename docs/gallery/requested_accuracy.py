"""
Requested accuracy and error
============================

The error that is requested, the bound that is returned, and the distance from the most accurate solution.
"""

import matplotlib.pyplot as plt

import fscm

problem = fscm.Problem(n=2, k=0, mu=1)
requested = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8]
best = fscm.solve(problem, "pull_off_force", accuracy=1e-10)
found = [fscm.solve(problem, "pull_off_force", accuracy=one) for one in requested]
figure, axes = plt.subplots(layout="constrained")
axes.loglog(requested, requested, color="0.7", label="requested")
axes.loglog(requested, [one.u_num / best.value for one in found], "s-", label="bound u_num")
axes.loglog(requested, [abs(one.value / best.value - 1) for one in found], "o", label="distance from the best")
axes.set(xlabel="requested relative error", ylabel="relative error", title="Pull-off force, n = 2, k = 0, mu = 1")
axes.legend(frameon=False)
plt.show()
