"""The baseline renewed from a run, by tier: all files or none; and a run compared with the baseline."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.baseline import BASELINE, drift, main, renew
from comparisons.numerics.bounds import combined
from comparisons.runs.csv_format import read_table, write_table
from comparisons.runs.frames import curve_frame, frame
from comparisons.runs.record import read_record, write_record
from tests.comparisons.records import record_of_run
from tests.comparisons.rows import row

COMMITTED = Path(__file__).parents[2] / BASELINE
RENEWED = {
    "quick": {
        *("quick.csv", "curves.csv", "largest_kappa.csv"),
        *("fig16b_kappa.png", "fig16b_kappa.pdf", "references.png"),
    },
    "full": {"references_agreement.csv", "references_agreement.png"},
}


def results(value=1.5):
    return frame([row("fscm", value=value, u_num=1e-9)])


def made_up(folder, tier, **arguments):
    """The folder of a run: every file that a run of any tier makes, with little content."""
    folder.mkdir()
    write_table(results(), folder / "results")
    curve = row("fscm", "force_curve", value=None, u_num=None, points=([0.0, 1.0], [2.0, 3.0], 1e-9))
    write_table(curve_frame([curve]), folder / "curves")
    pictures = "fig16b_kappa.png", "fig16b_kappa.pdf", "references.png", "agreement.png"
    for name in (*pictures, "largest_kappa.csv", "agreement.csv"):
        (folder / name).write_text(f"{name} of the {tier} run")
    write_record(record_of_run(tier=tier, **arguments), folder / "run.json")
    return folder


@pytest.fixture
def target(tmp_path):
    """A clone's committed results, all of them stale."""
    folder = tmp_path / "baseline"
    folder.mkdir()
    for name in RENEWED["quick"] | RENEWED["full"] | {"fem_pull_off.png"}:
        (folder / name).write_text("stale")
    return folder


def renewed(target):
    return {path.name for path in target.iterdir() if path.read_bytes() != b"stale"}


@pytest.mark.parametrize("tier", ["quick", "full"])
def test_each_tier_renews_its_files(tmp_path, target, tier):
    written = renew(made_up(tmp_path / "run", tier), target)
    assert {path.name for path in written} == RENEWED[tier] == renewed(target)
    if tier == "quick":
        assert (target / "quick.csv").read_text().splitlines() == [
            "model,quantity,n,k,mu,nu,value,u_num,status,reason",
            "fscm,pull_off_force,2,0.4,1,,1.5,1.0000000000000001e-09,ok,",
        ]
        assert pd.read_csv(target / "curves.csv")["y"].tolist() == [2.0, 3.0]
        assert (target / "largest_kappa.csv").read_text() == "largest_kappa.csv of the quick run"
    else:
        assert (target / "references_agreement.csv").read_text() == "agreement.csv of the full run"


def longer(path):
    path.write_bytes(path.read_bytes() + b" ")


@pytest.mark.parametrize(
    ("tier", "arguments", "damage", "words"),
    [
        ("quick", {}, Path.unlink, "results.csv"),
        ("quick", {}, Path.unlink, "references.png"),
        ("full", {}, Path.unlink, "agreement.csv"),
        ("quick", {}, longer, "results.csv"),
        ("quick", {}, longer, "largest_kappa.csv"),
        ("quick", {"model": ["jkr", "dmt"]}, None, "--model "),
        ("quick", {"gates": "mine.toml"}, None, "--gates "),
        ("quick", {"tier": None}, None, "standing cases"),
    ],
)
def test_a_run_that_is_no_whole_one_of_the_standing_cases_renews_nothing(
    tmp_path, target, tier, arguments, damage, words
):
    run = made_up(tmp_path / "run", **{"tier": tier} | arguments)
    if damage:
        damage(run / words)
    with pytest.raises(ValueError, match=words):
        renew(run, target)
    assert renewed(target) == set()


def test_a_run_is_compared_with_what_is_committed(tmp_path, monkeypatch, capsys):
    run = made_up(tmp_path / "run", "quick")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("comparisons.data.file_names._CLONE", tmp_path / "no-clone")
    assert main(["--check", str(run)]) == 2
    message = capsys.readouterr().err
    assert (message.count("\n"), "a clone" in message) == (1, True)
    renew(run)
    assert main(["--check", str(run)]) == 0
    write_table(results(1.5 + 3e-9), run / "results")
    assert main(["--check", str(run)]) == 2
    assert "results.csv was changed" in capsys.readouterr().err
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
    ("changes", "count"),
    [
        ({}, 0),
        ({"fem": (1.5 + 1.5e-7, 1e-7)}, 1),  # within both bounds at mu = 1 only
        ({"fscm": (1.5 + 3e-9, 1e-9)}, 2),
        ({"fem": (1.5, 4e-7)}, 3),
        ({"fscm": (1.5, 2e-10)}, 2),
        ({"mus": (1.0,)}, 2),
    ],
)
def test_both_references_of_a_full_run_are_compared(changes, count, tmp_path, monkeypatch, capsys):
    run = made_up(tmp_path / "full", "full")
    monkeypatch.chdir(tmp_path)
    BASELINE.mkdir(parents=True)
    agreement_csv(BASELINE / "references_agreement.csv")
    agreement_csv(run / "agreement.csv", **changes)
    write_record(read_record(run / "run.json"), run / "run.json")
    assert main(["--check", str(run)]) == (1 if count else 0)
    assert capsys.readouterr().out.count("pull_off_force") == count


def test_the_committed_references_agree_within_both_bounds():
    rows = read_table(COMMITTED / "references_agreement.csv")
    difference = rows["value"] - rows["reference_value"]
    bound = combined(rows["u_num"], rows["u_reference"])
    assert (np.abs(difference) <= bound).all()
    assert rows["en"].to_numpy() == pytest.approx((difference / bound).to_numpy(), rel=1e-6)
    # Four shapes, four gradients and four Tabor numbers; not every problem has a jump.
    assert rows.groupby("quantity").size().drop("critical_tabor_number").ge(45).sum() == 8


def table(**changes):
    common = {"model": "fscm", "quantity": "pull_off_force", "n": 2.0, "k": 0.4, "mu": [0.5, 1.0], "nu": np.nan}
    return pd.DataFrame({**common, "value": [1.8, 1.7], "u_num": [1e-9, 2e-9], "status": "ok", **changes})


STORED = table()


@pytest.mark.parametrize(
    ("stored", "computed", "count"),
    [
        (STORED, STORED, 0),
        # Rows that are not computed do not matter, and those that are not stored do.
        (STORED, STORED.head(1), 0),
        (STORED.head(1), STORED, 1),
        (STORED, table(status=["ok", "failed"]), 1),
        # Values may differ by the sum of both bounds, and by no more.
        *(
            (STORED, table(value=STORED["value"] + apart * 3.0 * STORED["u_num"], u_num=2.0 * STORED["u_num"]), count)
            for apart, count in ((0.9, 0), (1.1, 2), (-1.1, 2))
        ),
        *((STORED, table(u_num=factor * STORED["u_num"]), count) for factor, count in ((0.3, 2), (0.34, 0), (2.9, 0))),
        (STORED, table(u_num=3.1 * STORED["u_num"]), 2),
        # Bounds of rounding do not drift.
        (table(u_num=0.0), table(u_num=1e-13), 0),
        (table(u_num=0.0), table(u_num=6e-13), 2),
    ],
)
def test_values_bounds_and_statuses_drift_beyond_both_bounds(stored, computed, count):
    assert len(drift(stored, computed)) == count
    if len(stored) == len(computed):
        assert len(drift(computed, stored)) == count
