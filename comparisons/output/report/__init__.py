"""One self-contained HTML page of the stored results in a run folder."""
