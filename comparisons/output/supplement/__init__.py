"""The supplement of a paper: tables, figures, Methods and references of a run in LaTeX, and its data as a package."""
