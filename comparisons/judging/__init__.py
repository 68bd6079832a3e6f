"""Gates, decisions and verdicts."""
