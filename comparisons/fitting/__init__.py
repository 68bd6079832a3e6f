"""Values of a problem file from measured force-displacement curves."""
