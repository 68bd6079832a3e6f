"""A small run folder, written by the functions that a run uses, in which every external text is hostile."""

import math
from pathlib import Path

import numpy as np
import pandas as pd

from comparisons.judging.gates import gates_text, load_gates
from comparisons.output.errors import largest, relative_error
from comparisons.output.verdicts import write_verdicts
from comparisons.runs.csv_format import write_table
from comparisons.runs.frames import curve_frame, frame
from comparisons.runs.record import read_record, write_record
from tests.comparisons.records import record_of_run
from tests.comparisons.rows import row as made_row

IMAGE = """<img src=x onerror="window.hostile='image'">"""
SCRIPT = "</script><script>window.hostile='script'</script><!--<script>"
LINE = "one\u2028two'\"&<b>"
SPECS = {IMAGE: "my models/it's.py:Model", SCRIPT: "plain.py:Model"}
REFUSED = {"u_num": None, "size": None, "iterations": None, "residual": None}


def row(model, mu, value=None, **more):
    content = {"model_version": f"1 {IMAGE}", "u_num": 1e-9, "unit": "pi Q^(2/n) dgamma z0^(2/n-1)"}
    return made_row(model, mu=mu, value=value, **(content | more))


def rows():
    for n in (1.0, 2.0):
        for k in (0.0, 0.4):
            for mu in np.geomspace(0.01, 5, 22).tolist():
                true = 1.5 + n + k + 0.1 * math.log(mu)
                yield row("fscm", mu, true, n=n, k=k, size=400 + int(30 * mu), u_num=1e-8 * mu, iterations=5)
                yield row(IMAGE, mu, true * (1 + 0.1 * mu), n=n, k=k, u_num=0.01)
                yield row(SCRIPT, mu, true * (0.9 + 0.02 * mu), n=n, k=k)
                yield row("jkr", mu, n=n, k=k, status="failed", reason=f"{SCRIPT} {LINE}", **REFUSED)
    for mu in (0.5, 1.0):
        more = {"size": 20000, "u_num": 4e-7}
        yield row("fem", mu, 1.9 + mu, quantity="zero_load_displacement", **more)


def curves():
    phi = np.linspace(-2.0, 2.0, 41)
    for model, shift in (("fscm", 0.0), (SCRIPT, 0.01)):
        x, y = phi**3 / 2 - phi / 2 + shift, phi**2 - 1.7
        yield row(model, 1.0, quantity="force_curve", points=(x.tolist(), y.tolist(), 1e-6), u_num=None)
        gap = ([0.0, 1.0, 2.0], [0.2 + shift, 1.0 + shift, 3.0 + shift], 1e-6)
        yield row(model, 1.0, quantity="pull_off_gap", points=gap, u_num=None)
    yield row(IMAGE, 1.0, quantity="force_curve", status="not-applicable", reason=LINE, **REFUSED)


def judged(gate, candidate, mu, verdict, error, *, reason="", uncertainty=1e-8):
    values = {"value": 2.0 * (1 + (error or 0.0)), "u_num": 1e-9, "reference_value": 2.0, "u_reference": 1e-9}
    return {
        **{"gate": gate, "quantity": "pull_off_force", "candidate": candidate, "reference": "fscm"},
        **{"n": 2.0, "k": 0.4, "mu": mu, "nu": None, **values},
        **{"error": error, "uncertainty": None if error is None else uncertainty},
        **{"lower": -0.1, "upper": math.inf if gate.startswith("FE") else 0.1, "verdict": verdict, "reason": reason},
        "status": {"ERROR": "failed", "NOT-APPLICABLE": "not-applicable"}.get(verdict, "ok"),
    }


VERDICTS = [
    *(judged("JKR-LIMIT-PULL-OFF", SCRIPT, mu, "PASS", 0.05 * mu) for mu in (0.1, 0.5, 1.0)),
    judged("JKR-LIMIT-PULL-OFF", SCRIPT, 2.0, "FAIL", 0.123456789),
    judged("JKR-LIMIT-PULL-OFF", SCRIPT, 3.0, "FAIL", 0.2),
    judged("FE-PULL-OFF-FORCE", "jkr", 1.0, "ERROR", None, reason=f"jkr: failed: {SCRIPT}"),
    judged("DMT-LIMIT", IMAGE, 1.0, "INCONCLUSIVE", 0.0999, uncertainty=0.02, reason=LINE),
    judged("DMT-LIMIT", IMAGE, 2.0, "NOT-APPLICABLE", None, reason=f"{IMAGE}: {LINE}"),
]


def record(count):
    described = {"version": LINE, "citation": f"{IMAGE} {LINE}", "domain": SCRIPT}
    return record_of_run(model=[IMAGE, SCRIPT], external=SPECS, grid=LINE) | {
        "command": ["fscm-bench", "run", SCRIPT],
        "models": {SCRIPT: described, IMAGE: described},
        "rows": {"all": count, "resumed": 0, "ok": count},
    }


def write_run(folder: Path) -> Path:
    folder.mkdir()
    every = list(rows())
    table = frame(every)
    kappa = relative_error(table[table["quantity"] == "pull_off_force"], "fscm")
    write_table(table, folder / "results")
    write_table(curve_frame(curves()), folder / "curves")
    write_table(kappa, folder / "kappa")
    write_table(largest(kappa), folder / "largest_kappa")
    write_verdicts(folder, pd.DataFrame(VERDICTS), [], load_gates(gates_text()), SPECS)
    write_record(record(len(every)), folder / "run.json")
    return folder


def seal(folder):
    """Give the record of a run the checksums of its files as they are now."""
    write_record(read_record(folder / "run.json"), folder / "run.json")
