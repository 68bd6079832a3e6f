"""Values of the references that are shipped: as they were computed, whole, and of the solvers that are here."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from comparisons.baseline import BASELINE, drift, read_baseline
from comparisons.quantities import CURVES
from comparisons.runs import code_files
from comparisons.runs.cases import grids
from comparisons.runs.environment import environment
from comparisons.runs.frames import curve_frame, frame, rows_of
from comparisons.runs.rows import Row
from comparisons.runs.shipped_values import FOLDER, SHIPPED_MODELS, load_shipped, write_shipped
from comparisons.runs.tasks import plan

ROOT = Path(__file__).parents[3]

#: The command that computes and ships the values again; it takes about two minutes on two cores.
COMMAND = "fscm-bench run --recompute --out results/runs/new && python -m comparisons.baseline results/runs/new"

#: A wheel and a clone have this many bytes at most: the tables are for twelve curves and three hundred numbers.
LARGEST = 500_000

NUMBERS = {"size": 7, "iterations": 3, "residual": 1e-12, "seconds": 0.123456, "observed_order": 2.5}
NOTHING = {"size": None, "iterations": None, "residual": None, "seconds": 0.25}


def row(model, quantity, nu=None, **more):
    common = {"value": None, "u_num": None, "unit": "z0", "status": "ok", "reason": ""}
    return Row(model, "1", quantity, 2.0, 0.4, 1.0, nu, **{**common, **more})


ROWS = [
    row("fscm", "pull_off_force", value=1.7884817104030487, u_num=5e-11, **NUMBERS),
    row("fem", "pull_off_force", nu=0.25, value=0.1 + 0.2, u_num=1e-8, **NUMBERS),
    row("fem", "jump_in_gap", status="not-applicable", reason="-min P, no jump", **NOTHING),
    row("fscm", "force_curve", points=([0.1, 1 / 3], [-0.7, 1e-300], 1e-5), **NOTHING),
    row("fem", "force_curve", status="not-applicable", reason="none", **NOTHING),
]
LEFT_OUT = [
    row("jkr", "pull_off_force", value=1.7, u_num=1e-15, **NUMBERS),
    row("fem", "jump_out_gap", status="failed", reason="it did not converge", **NOTHING),
]


def record():
    started = "2026-01-01T00:00:00+00:00"
    return {"parts": [{"started": started, "seconds": 1.0, "computations": 2}], **environment()}


def by_key(rows):
    return {one.key: one for one in rows}


def test_tables_give_their_rows_back():
    rows = [*ROWS, *LEFT_OUT]
    tables = (
        frame(one for one in rows if one.quantity not in CURVES),
        curve_frame(one for one in rows if one.quantity in CURVES),
    )
    assert by_key(rows_of(*tables)) == by_key(rows)


def test_what_is_shipped_is_read_with_every_digit_but_those_of_the_time(tmp_path):
    write_shipped(record(), [*ROWS, *LEFT_OUT], tmp_path)
    found = load_shipped(tmp_path)
    assert found.rows.keys() == by_key(ROWS).keys()
    for key, stored in by_key(ROWS).items():
        now = found.rows[key]
        assert {name: getattr(now, name) for name in Row.__slots__ if name != "seconds"} == {
            name: getattr(stored, name) for name in Row.__slots__ if name != "seconds"
        }
        assert now.seconds == pytest.approx(stored.seconds, rel=5e-3)
    assert found.origin["parts"] == record()["parts"]
    assert found.obstacle == ""


def test_values_of_other_solvers_are_not_used(tmp_path, monkeypatch):
    write_shipped(record(), ROWS, tmp_path)
    monkeypatch.setattr("comparisons.runs.shipped_values.solver_digest", lambda: "0" * 64)
    found = load_shipped(tmp_path)
    assert found.rows == {}
    assert "now 000000000000" in found.obstacle


def test_a_changed_file_is_refused(tmp_path):
    write_shipped(record(), ROWS, tmp_path)
    text = (tmp_path / "results.csv").read_text()
    (tmp_path / "results.csv").write_text(text.replace("1.788", "1.789"))
    with pytest.raises(ValueError, match=r"results\.csv are not those that were written"):
        load_shipped(tmp_path)


def test_the_digest_covers_both_solvers_and_their_models(tmp_path):
    for path in (
        *("fscm/solver.py", "fscm/tables/values.toml", "fem_reference/mesh.py"),
        *(f"comparisons/{name}" for name in code_files.SOLVER_MODULES),
    ):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text("x = 1\n")
    digests = {code_files.solver_digest(tmp_path)}
    for path in ("fscm/solver.py", "fscm/tables/values.toml", "fem_reference/mesh.py", "comparisons/model.py"):
        (tmp_path / path).write_text("x = 2\n")
        digests.add(code_files.solver_digest(tmp_path))
    assert len(digests) == 5
    (tmp_path / "comparisons/judge.py").write_text("the judge changes no value")
    (tmp_path / "fscm/__pycache__").mkdir()
    (tmp_path / "fscm/__pycache__/solve.pyc").write_bytes(b"0")
    assert code_files.solver_digest(tmp_path) in digests


def test_the_digest_covers_all_that_the_models_of_the_references_import():
    program = (
        "import sys, comparisons.models.fscm_model, comparisons.models.fem_model, comparisons.quantities\n"
        "print(*(module.__file__ for name, module in sys.modules.items() if name.startswith('comparisons')))"
    )
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT)
    names = {Path(name).relative_to(ROOT / "comparisons").as_posix() for name in loaded.stdout.split()}
    # Packages without code of their own.
    assert names - {"__init__.py", "models/__init__.py", "numerics/__init__.py"} == set(code_files.SOLVER_MODULES)


def test_the_shipped_values_are_of_the_solvers_that_are_here():
    obstacle = load_shipped().obstacle
    assert obstacle == "", f"the solvers have changed ({obstacle}): ship their values by\n{COMMAND}"


def test_the_shipped_values_are_those_of_every_standing_case():
    wanted = {task.key for task in plan(grids("quick")) if task.model in SHIPPED_MODELS}
    stored = json.loads((FOLDER / "origin.json").read_text())
    assert stored["parts"]
    rows = load_shipped().rows
    missing = sorted(wanted - rows.keys(), key=str)
    assert not missing, f"not shipped, e.g. {missing[0]}: ship them by\n{COMMAND}"
    assert not rows.keys() - wanted, f"shipped for no standing case: leave them out by\n{COMMAND}"
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) < LARGEST


def test_the_shipped_values_are_those_of_the_baseline():
    shipped = load_shipped().rows
    results, _ = read_baseline(ROOT / BASELINE)
    numbers = frame(one for one in shipped.values() if one.quantity not in CURVES)
    assert not numbers.empty
    assert drift(results, numbers).empty


def test_the_check_before_a_change_is_taken_in_tests_the_solvers():
    lines = (ROOT / ".ci" / "run").read_text().splitlines()
    (command,) = (line for line in lines if line.startswith("run_command="))
    assert "--recompute" in command
