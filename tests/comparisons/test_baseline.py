"""The baseline renewed from a run, by tier: all files or none; and a run compared with the baseline."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.baseline import BASELINE, main, renew
from comparisons.numerics.bounds import combined
from comparisons.runs.csv_format import read_csv
from comparisons.runs.environment import computing_environment, environment
from comparisons.runs.frames import curve_frame, frame, write_table
from comparisons.runs.record import read_record, write_record
from tests.comparisons.rows import row as made_row

COMMITTED = Path(__file__).parents[2] / BASELINE
FROM_QUICK = {
    *("quick.csv", "curves.csv", "largest_kappa.csv"),
    *("fig16b_kappa.png", "fig16b_kappa.pdf", "references.png"),
}
FROM_FULL = {"references_agreement.csv", "references_agreement.png"}
EVENTS = (
    "pull_off_force",
    "pull_off_displacement",
    "jump_in_displacement",
    "jump_in_gap",
    "jump_out_displacement",
    "jump_out_gap",
    "zero_load_displacement",
    "hysteresis_energy",
)


def row(**more):
    return made_row(**({"model": "fscm", "value": None, "u_num": None, "unit": "", "seconds": 7.0} | more))


def made_up(folder, tier, model=None):
    """The folder of a run: every file that a run of any tier makes, with little content."""
    folder.mkdir()
    write_table(frame([row(value=1.5, u_num=1e-9)]), folder / "results")
    write_table(curve_frame([row(quantity="force_curve", points=([0.0, 1.0], [2.0, 3.0], 1e-9))]), folder / "curves")
    for name in ("fig16b_kappa", "references", "agreement"):
        for suffix in ("png", "pdf"):
            (folder / f"{name}.{suffix}").write_text(f"{name} of the {tier} run")
    for name in ("largest_kappa", "agreement"):
        (folder / f"{name}.csv").write_text(f"{name} of the {tier} run")
    arguments = {
        "tier": tier,
        "model": model,
        "grid": None,
        "external": {},
        "gates": None,
        "jobs": 2,
        "out": str(folder),
    }
    record = {
        "format": 5,
        "command_name": "run",
        "arguments": arguments,
        "command": ["fscm-bench", "run"],
        "started": "2026-01-01T00:00:00+00:00",
        "finished": "2026-01-01T00:00:09+00:00",
        "seconds": {"run": 9.0, "by_model": {"fscm": 8.5}},
        "models": {},
        "rows": {"all": 2, "resumed": 0, "ok": 2},
        "cases_sha256": "0" * 64,
        "gates_sha256": "f" * 64,
        "verdicts": {"all": "PASS", "PASS": 2},
        "parts": [
            {"started": "2026-01-01T00:00:00+00:00", "seconds": 9.0, "computations": 2, **computing_environment()}
        ],
    }
    write_record(environment() | record, folder / "run.json")
    return folder


@pytest.fixture
def target(tmp_path):
    """A clone's committed results, all of them stale."""
    folder = tmp_path / "baseline"
    folder.mkdir()
    for name in FROM_QUICK | FROM_FULL | {"fem_pull_off.png"}:
        (folder / name).write_text("stale")
    return folder


def renewed(target):
    return {path.name for path in target.iterdir() if path.read_bytes() != b"stale"}


@pytest.mark.parametrize(("tier", "names"), [("quick", FROM_QUICK), ("full", FROM_FULL)])
def test_each_tier_renews_its_own(tmp_path, target, tier, names):
    written = renew(made_up(tmp_path / "run", tier), target)
    assert {path.name for path in written} == names == renewed(target)


def test_what_is_written_is_what_the_run_holds(tmp_path, target):
    renew(made_up(tmp_path / "quick", "quick"), target)
    renew(made_up(tmp_path / "full", "full"), target)
    assert (target / "quick.csv").read_text().splitlines() == [
        "model,quantity,n,k,mu,nu,value,u_num,status,reason",
        "fscm,pull_off_force,2,0.4,1,,1.5,1.0000000000000001e-09,ok,",
    ]
    assert pd.read_csv(target / "curves.csv")["y"].tolist() == [2.0, 3.0]
    assert (target / "largest_kappa.csv").read_text() == "largest_kappa of the quick run"
    assert (target / "references.png").read_text() == "references of the quick run"
    for suffix in ("csv", "png"):
        assert (target / f"references_agreement.{suffix}").read_text() == "agreement of the full run"


@pytest.mark.parametrize(
    ("tier", "lost"), [("quick", "results.parquet"), ("quick", "references.png"), ("full", "agreement.csv")]
)
def test_a_run_that_lacks_something_changes_nothing(tmp_path, target, tier, lost):
    run = made_up(tmp_path / "run", tier)
    (run / lost).unlink()
    with pytest.raises(ValueError, match=lost.replace(".", r"\.")):
        renew(run, target)
    assert renewed(target) == set()


@pytest.mark.parametrize("name", ["results.parquet", "fig16b_kappa.png", "largest_kappa.csv"])
def test_a_file_that_was_changed_after_the_run_changes_nothing(tmp_path, target, name):
    run = made_up(tmp_path / "run", "quick")
    with (run / name).open("ab") as file:
        file.write(b" ")
    with pytest.raises(ValueError, match=f"{name} was changed"):
        renew(run, target)
    assert renewed(target) == set()


@pytest.mark.parametrize(("option", "value"), [("model", ["jkr", "dmt"]), ("gates", "mine.toml")])
def test_a_run_of_chosen_models_or_gates_is_refused(tmp_path, target, option, value):
    run = made_up(tmp_path / "run", "quick")
    record = read_record(run / "run.json")
    record["arguments"][option] = value
    write_record(record, run / "run.json")
    with pytest.raises(ValueError, match=rf"--{option} "):
        renew(run, target)
    assert renewed(target) == set()


def test_outside_a_clone_the_copy_of_the_wheel_is_compared(tmp_path, monkeypatch, capsys):
    run, packed = made_up(tmp_path / "run", "quick"), tmp_path / "site-packages" / "baseline"
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("comparisons.runs.committed._INSTALLED", (tmp_path / "no-clone", packed))
    assert main(["--check", str(run)]) == 2
    shown = capsys.readouterr()
    assert (shown.out, shown.err.count("\n")) == ("", 1)
    assert "install the wheel of fscm-bench again" in shown.err
    renew(run, packed)
    assert main(["--check", str(run)]) == 0
    assert "agrees with the baseline" in capsys.readouterr().out


def test_a_run_is_compared_with_what_is_committed(tmp_path, monkeypatch, capsys):
    run, clone = made_up(tmp_path / "run", "quick"), tmp_path / "clone"
    monkeypatch.chdir(tmp_path)
    renew(run, clone / BASELINE)
    monkeypatch.chdir(clone)
    assert main(["--check", str(run)]) == 0
    write_table(frame([row(value=1.5 + 3e-9, u_num=1e-9)]), run / "results")
    assert main(["--check", str(run)]) == 2
    assert "results.csv was changed after it was written" in capsys.readouterr().err
    write_record(read_record(run / "run.json"), run / "run.json")
    assert main(["--check", str(run)]) == 1
    assert "1.500000003" in capsys.readouterr().out


def agreement_csv(path, *, fem=(1.5, 1e-7), fscm=(1.5, 1e-9), mus=(1.0, 2.0)):
    rows = [
        ["pull_off_force", "fem", 2.0, 0.4, mu, nu, fem[0] * mu, fem[1], "fscm", fscm[0] * mu, fscm[1], 0, 0, 0]
        # The last case has the same result of the FSCM as the first.
        for mu, nu in (*((mu, "") for mu in mus), (1.0, 0.49))
    ]
    names = "quantity model n k mu nu value u_num reference reference_value u_reference difference claimed en"
    pd.DataFrame(rows, columns=names.split()).to_csv(path, index=False)


@pytest.mark.parametrize(
    ("changes", "seen"),
    [
        ({}, 0),
        ({"fem": (1.5 + 1.5e-7, 1e-7)}, 1),  # within both bounds at mu = 1 only
        ({"fscm": (1.5 + 3e-9, 1e-9)}, 2),
        ({"fem": (1.5, 4e-7)}, 3),
        ({"fscm": (1.5, 2e-10)}, 2),
        ({"mus": (1.0,)}, 2),
    ],
)
def test_both_references_of_a_full_run_are_compared(changes, seen, tmp_path, monkeypatch, capsys):
    clone, run = tmp_path / "clone", made_up(tmp_path / "full", "full")
    (clone / BASELINE).mkdir(parents=True)
    agreement_csv(clone / BASELINE / "references_agreement.csv")
    agreement_csv(run / "agreement.csv", **changes)
    write_record(read_record(run / "run.json"), run / "run.json")
    monkeypatch.chdir(clone)
    assert main(["--check", str(run)]) == (1 if seen else 0)
    assert capsys.readouterr().out.count("pull_off_force") == seen


# The parser that older versions of pandas take by default is wrong in the last digit, which is much of a difference.
AGREEMENT = read_csv(COMMITTED / "references_agreement.csv", ("model", "quantity", "reference"))


#: The critical Tabor number has one value for each shape and gradient.
CRITICAL = "critical_tabor_number"


@pytest.mark.parametrize("event", [*EVENTS, CRITICAL])
def test_the_committed_references_agree_within_both_bounds(event):
    rows = AGREEMENT[AGREEMENT["quantity"] == event]
    assert set(AGREEMENT["quantity"]) == {*EVENTS, CRITICAL}
    # Over four shapes, four gradients and four Tabor numbers; not every problem has a jump.
    assert len(rows) >= (12 if event == CRITICAL else 45)
    assert set(rows["n"]) >= {1.0, 1.5, 2.0, 5.0}
    assert set(rows["k"]) == {0.0, 0.2, 0.4, 0.6}
    bound = combined(rows["u_num"], rows["u_reference"])
    difference = rows["value"] - rows["reference_value"]
    assert (np.abs(difference) <= bound).all()
    assert rows["en"].to_numpy() == pytest.approx((difference / bound).to_numpy(), rel=1e-6)
    assert (rows["difference"] / rows["claimed"]).to_numpy() == pytest.approx(rows["en"].to_numpy(), rel=1e-12)
