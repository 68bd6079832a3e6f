"""How the data of the atlas were made: nodes, fit of the series, bounds."""
