"""The full self-consistent model of adhesive contact of power-law graded materials."""
