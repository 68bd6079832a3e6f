"""Bounds on the error of a value: defect on a finer mesh, adjoint, and parts by cause."""
