"""Problems in physical units, read from a file, and their values by each model."""
