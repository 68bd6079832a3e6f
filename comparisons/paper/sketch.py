"""Fig. 1: a rigid punch above a graded half-space, drawn; no computation."""

from comparisons.paper.plate import Plate

SKETCH = Plate("1", "fig01_sketch", "x", list, lambda a: {}, None)
