"""Linear solvers of the half-space and their preconditioner."""
