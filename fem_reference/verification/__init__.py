"""Verification of the finite elements: checks against exact solutions, and the study of the linear solver."""
