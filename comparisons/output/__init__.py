"""Output of results and verdicts: tables, figures, LaTeX, Markdown, JUnit XML and the report."""
