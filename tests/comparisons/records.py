"""A made up record of a run."""

from comparisons.runs.environment import computing_environment, environment

_TIME = "2026-01-01T00:00:00+00:00"


def record_of_run(**arguments):
    """The record of a run of the quick tier, without checksums; some of its arguments may be others."""
    standing = {"tier": "quick", "grid": None, "model": None, "external": {}, "gates": None}
    return environment() | {
        "format": 6,
        "command_name": "run",
        "arguments": standing | arguments,
        "command": ["fscm-bench", "run"],
        "started": _TIME,
        "finished": _TIME,
        "seconds": {"run": 9.0, "by_model": {"fscm": 8.5}},
        "rows": {"all": 2, "resumed": 0, "ok": 2},
        "cases_sha256": "0" * 64,
        "gates_sha256": "f" * 64,
        "models": {"fscm": {"version": "1", "citation": "none", "domain": "all"}},
        "verdicts": {"all": "PASS", "PASS": 2},
        "parts": [{"started": _TIME, "seconds": 9.0, "computations": 2, **computing_environment()}],
    }
