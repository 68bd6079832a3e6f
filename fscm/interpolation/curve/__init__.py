"""Force curves of the FSCM from series: the pieces of the path, their series in n, k and mu, and the limits beyond."""
