"""Figures of stored results, one module each; `registry` lists those of a run."""
