"""An independent axisymmetric finite-element model of adhesive contact of graded materials."""
