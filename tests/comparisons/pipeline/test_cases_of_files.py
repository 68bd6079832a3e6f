"""Cases of problem files: computed, judged by gates, resumed and compared as cases of n, k and mu are."""

import json
import math

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.problem.variation import parse_variations, problems_of
from tests.comparisons.conftest import GATES, with_entries
from tests.comparisons.external.conftest import model_file
from tests.comparisons.grid_text import PAD, grid_text

VARY = {"solid.E": ["1 MPa", "2 MPa", "30 MPa"]}
PADS = grid_text(["jkr"], id="pads", problem="pad.toml", vary=VARY)
CASES = PADS + grid_text(["jkr"], id="numbers", n=[2], k=[0], mu=[1])
#: JKR has three quarters of the force of a rigid solid.
GATE = with_entries(GATES, id="PADS", reference="bradley", lower=-0.2501)
SOFT = '"solid.kind" = "homogeneous", "solid.E" = ["0.5 MPa", "20 MPa"]'
#: The force of JKR for 1 um, in newtons.
FORCE = 1.5 * math.pi * 1e-6 * 0.05


@pytest.fixture
def run(tmp_path):
    (tmp_path / "pad.toml").write_text(PAD)
    (tmp_path / "cases.toml").write_text(CASES)

    def call(*options, cases=SOFT, upper=-0.2499, least=2, value=None):
        candidate = "jkr" if value is None else "given"
        entries = {"candidate": candidate, "cases": f"{{ {cases} }}", "upper": upper, "min_cases": least}
        (tmp_path / "gates.toml").write_text(with_entries(GATE, **entries))
        if value is not None:
            options += ("--model", model_file(tmp_path, f"return Result({value}, 0.0)", "mine"))
        files = ["--cases", str(tmp_path / "cases.toml"), "--gates", str(tmp_path / "gates.toml")]
        return main(["run", *files, *options, "--jobs", "1", "--quiet", "--out", str(tmp_path / "out")])

    return call


def verdicts(folder):
    return pd.read_csv(folder / "out" / "verdicts.csv")


def record(folder):
    return json.loads((folder / "out" / "run.json").read_text())


def test_a_gate_selects_the_problems_by_their_keys_and_can_fail(run, tmp_path):
    assert run() == 0
    judged = verdicts(tmp_path)
    assert sorted(judged["problem"]) == ["pad.toml; solid.E=1 MPa", "pad.toml; solid.E=2 MPa"]
    assert judged["verdict"].tolist() == ["PASS", "PASS"]
    assert judged["value"].to_numpy() == pytest.approx(FORCE, rel=1e-9)
    assert run(upper=-0.25005) == 1
    assert set(verdicts(tmp_path)["verdict"]) == {"FAIL"}
    # The problems of files have no n.
    for cases, count in (('"punch.kind" = "sphere"', 3), ('tags = ["numbers"]', 1), ("n = [2, 2]", 1)):
        assert run(cases=cases, least=count) == 0
        assert len(verdicts(tmp_path)) == count


def test_stored_results_count_only_for_the_content_of_the_file_and_the_folder_has_what_its_pages_need(run, tmp_path):
    assert run() == 0
    (tmp_path / "pad.toml").write_text(PAD.replace("1 um", "2 um"))
    assert run() == 0
    assert record(tmp_path)["rows"]["resumed"] == 2
    assert verdicts(tmp_path)["value"].iloc[0] == pytest.approx(2 * FORCE)
    (tmp_path / "pad.toml").write_text(PAD)
    assert run() == 0
    for name in ("pad.toml", "cases.toml", "gates.toml"):
        (tmp_path / name).unlink()
    copy = tmp_path / "out" / "inputs" / "pad.toml"
    assert copy.read_text() == PAD
    assert main(["judge", str(tmp_path / "out")]) == 0
    assert len(verdicts(tmp_path)) == 2
    assert main(["report", str(tmp_path / "out")]) == 0
    assert "solid.E=2 MPa" in (tmp_path / "out" / "report.html").read_text()
    copy.write_text(PAD.replace("0.4}", "0.3}"))
    assert main(["judge", str(tmp_path / "out")]) == 2


def test_a_model_that_knows_the_problems_by_heart_is_wrong_in_fresh_ones(run, tmp_path):
    (tmp_path / "cases.toml").write_text(PADS)
    known = [problem.mu for problem in problems_of(tmp_path / "pad.toml", parse_variations(["solid.E=1, 2 MPa"]))]
    value = f"1.5 if any(abs(problem.mu / mu - 1) < 1e-9 for mu in {known}) else 2.0"
    assert run("--random", "6", "--seed", "1", value=value) == 1
    judged = verdicts(tmp_path)
    assert set(judged.loc[judged["gate"] == "PADS", "verdict"]) == {"PASS"}
    fresh = judged[(judged["gate"] == "PADS-RANDOM") & judged["problem"].notna()]
    assert fresh["verdict"].tolist() == ["FAIL"] * 6
    # The fresh problems are between the stated ones, and none is one of them.
    values = [float(label.rpartition("=")[2].removesuffix(" Pa")) for label in fresh["problem"]]
    assert all(1e6 < value < 2e6 for value in values)
    # They are judged again from the folder alone.
    (tmp_path / "pad.toml").unlink()
    assert main(["judge", str(tmp_path / "out")]) == 1
