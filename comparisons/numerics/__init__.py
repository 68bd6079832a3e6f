"""Grid convergence and distances of curves."""
