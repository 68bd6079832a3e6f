"""Atlas of the FSCM: Chebyshev series in n, k and mu with their bounds, and the commands that fit them to nodes."""
