"""Studies beyond the paper: error maps, solids that are no power law."""
