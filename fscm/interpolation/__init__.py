"""Atlas of the FSCM: Chebyshev series in n, k and mu, their bounds, and the fit of both to a table of nodes."""
