"""Cases of problem files: computed, judged by gates, resumed, sharded and compared as cases of n, k and mu are."""

import json

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.problem.reading import load_problem

PAD = """
solid = {kind = "homogeneous", E = "2 MPa", nu = 0.4}
punch = {kind = "sphere", R = "1 um"}
law = {kind = "lennard-jones-9-3", work_of_adhesion = "50 mJ/m^2", z0 = "0.4 nm"}
"""

CASES = """
[[grid]]
id = "pads"
title = "Pads"
reference = "bradley"
models = ["jkr"]
quantities = ["pull_off_force"]
problem = "pad.toml"
vary = { "solid.E" = ["1 MPa", "2 MPa", "30 MPa"] }

[[grid]]
id = "numbers"
title = "A case of three numbers"
reference = "bradley"
models = ["jkr"]
quantities = ["pull_off_force"]
n = [2]
k = [0]
mu = [1]
"""

GATE = """
[[gate]]
id = "PADS"
requirement = "JKR has three quarters of the force of a rigid solid."
quantity = "pull_off_force"
candidate = "jkr"
reference = "bradley"
cases = {{ {cases} }}
metric = "rel"
lower = {lower}
upper = {upper}
max_reference_uncertainty = 1e-6
basis = "derived"
grounds = "3/2 and 2 pi R w"
min_cases = {least}
tier = "quick"
"""

SOFT = '"solid.kind" = "homogeneous", "solid.E" = ["0.5 MPa", "20 MPa"]'


@pytest.fixture
def run(tmp_path):
    (tmp_path / "pad.toml").write_text(PAD)
    (tmp_path / "cases.toml").write_text(CASES)

    def call(cases=SOFT, lower=-0.2501, upper=-0.2499, least=2):
        (tmp_path / "gates.toml").write_text(GATE.format(cases=cases, lower=lower, upper=upper, least=least))
        files = ["--cases", str(tmp_path / "cases.toml"), "--gates", str(tmp_path / "gates.toml")]
        return main(["run", *files, "--jobs", "1", "--quiet", "--out", str(tmp_path / "out")])

    return call


def verdicts(folder):
    return pd.read_csv(folder / "verdicts.csv")


def test_a_gate_selects_the_problems_by_their_keys(run, tmp_path):
    assert run() == 0
    found = verdicts(tmp_path / "out")
    assert sorted(found["problem"]) == ["pad.toml; solid.E=1 MPa", "pad.toml; solid.E=2 MPa"]
    assert found["verdict"].tolist() == ["PASS", "PASS"]
    # 3/2 pi R w in newtons.
    assert found["value"].to_numpy() == pytest.approx(1.5 * 3.141592653589793 * 1e-6 * 0.05, rel=1e-9)


def test_a_wrong_model_fails(run, tmp_path):
    assert run(lower=-0.1, upper=0.1) == 1
    assert set(verdicts(tmp_path / "out")["verdict"]) == {"FAIL"}


@pytest.mark.parametrize(
    ("cases", "count"),
    [
        ('"punch.kind" = "sphere"', 3),
        ('"solid.E" = ["30 MPa", "30 MPa"]', 1),
        ('tags = ["numbers"]', 1),
        # The problems of files have no n.
        ("n = [2, 2]", 1),
    ],
)
def test_the_keys_of_a_gate(run, tmp_path, cases, count):
    assert run(cases=cases, least=count) == 0
    assert len(verdicts(tmp_path / "out")) == count


@pytest.mark.parametrize(
    ("cases", "words"),
    [
        ('"solid.thicknes" = ["1 nm", "2 nm"]', ["solid.thicknes", "solid.thickness"]),
        ('"solid.thickness" = ["1 nm", "2 MPa"]', ["solid.thickness", "unit"]),
        ('"solid.thickness" = ["2 nm", "1 nm"]', ["solid.thickness", "low <= high"]),
        ('"solid.kind" = "rubber"', ["solid.kind", "rubber", "coating"]),
        ('"solid.kind" = [1, 2]', ["solid.kind", "coating"]),
    ],
)
def test_wrong_keys_of_a_gate_are_refused_in_one_sentence(run, capsys, cases, words):
    assert run(cases=cases) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert all(word in message for word in words)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (('problem = "pad.toml"', 'problem = "../pad.toml"'), ["../pad.toml"]),
        (('problem = "pad.toml"', 'problem = "no.toml"'), ["no.toml"]),
        (('problem = "pad.toml"', 'problem = "pad.toml"\nn = [2]'), ["problem", "n"]),
        (('"solid.E"', '"solid.R"'), ["solid", "R"]),
        (('"1 MPa", ', '"1 nm", '), ["1 nm"]),
        (('"1 MPa", ', '"2 MPa", '), ["solid.E", "twice"]),
    ],
)
def test_wrong_grids_are_refused_in_one_sentence(run, tmp_path, capsys, change, words):
    (tmp_path / "cases.toml").write_text(CASES.replace(*change))
    assert run() == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert all(word in message for word in words)
    assert not (tmp_path / "out").exists()


def test_the_folder_has_all_that_its_judgement_and_its_pages_need(run, tmp_path):
    assert run() == 0
    for name in ("pad.toml", "cases.toml", "gates.toml"):
        (tmp_path / name).unlink()
    assert (tmp_path / "out" / "inputs" / "pad.toml").read_text() == PAD
    assert main(["judge", str(tmp_path / "out")]) == 0
    assert len(verdicts(tmp_path / "out")) == 2
    assert main(["report", str(tmp_path / "out")]) == 0
    page = (tmp_path / "out" / "report.html").read_text()
    assert "solid.E=2 MPa" in page
    (tmp_path / "out" / "inputs" / "pad.toml").write_text(PAD.replace("0.4}", "0.3}"))
    assert main(["judge", str(tmp_path / "out")]) == 2


def test_stored_results_count_only_for_the_content_of_the_file(run, tmp_path):
    assert run() == 0
    (tmp_path / "out" / "run.json").unlink()
    assert run() == 0
    assert json.loads((tmp_path / "out" / "run.json").read_text())["rows"]["resumed"] == 8
    (tmp_path / "pad.toml").write_text(PAD.replace("1 um", "2 um"))
    assert run() == 0
    assert json.loads((tmp_path / "out" / "run.json").read_text())["rows"]["resumed"] == 2
    assert verdicts(tmp_path / "out")["value"].iloc[0] == pytest.approx(3.0 * 3.141592653589793 * 1e-6 * 0.05)


def test_shards_of_a_sweep_are_merged(run, tmp_path):
    (tmp_path / "pad.toml").write_text(PAD)
    (tmp_path / "cases.toml").write_text(CASES)
    sweep = ["sweep", str(tmp_path / "cases.toml"), "--jobs", "1", "--quiet", "--out"]
    assert main([*sweep, str(tmp_path / "whole")]) == 0
    for part in ("1", "2"):
        assert main([*sweep, str(tmp_path / part), "--shard", f"{part}/2"]) == 0
    assert main(["merge", str(tmp_path / "1"), str(tmp_path / "2"), "--out", str(tmp_path / "merged")]) == 0
    whole, merged = ((tmp_path / name / "results.csv").read_bytes() for name in ("whole", "merged"))
    assert whole == merged
    assert (tmp_path / "merged" / "inputs" / "pad.toml").read_text() == PAD


def test_a_comparison_has_the_problems(run, tmp_path):
    (tmp_path / "pad.toml").write_text(PAD)
    (tmp_path / "cases.toml").write_text(CASES)
    command = ["compare", "jkr", "--grid", str(tmp_path / "cases.toml"), "--jobs", "1", "--out", str(tmp_path / "c")]
    assert main(command) == 0
    table = pd.read_csv(tmp_path / "c" / "comparison.csv")
    assert table["kappa"].to_numpy() == pytest.approx(-0.25, abs=1e-9)
    assert table["problem"].fillna("").tolist().count("") == 1


def test_cases_of_a_file_need_gates_and_no_tier(run, tmp_path, capsys):
    (tmp_path / "cases.toml").write_text(CASES)
    for options in ([], ["--tier", "quick", "--gates", "x.toml"]):
        assert main(["run", "--cases", str(tmp_path / "cases.toml"), *options]) == 2
        assert capsys.readouterr().err.count("\n") == 1


RANDOM_MODEL = """
import random

from comparisons import Result

class Noise:
    name = "noise"
    version = "1"
    citation = "none"
    domain = "everywhere"

    def evaluate(self, problem, quantity):
        return Result(1.5 + 1e-3 * random.random(), 0.0)
"""


def test_a_random_model_is_seen_on_problems_of_files_alone(run, tmp_path):
    (tmp_path / "noise.py").write_text(RANDOM_MODEL)
    (tmp_path / "cases.toml").write_text(CASES.split('[[grid]]\nid = "numbers"')[0])
    (tmp_path / "gates.toml").write_text(
        GATE.format(cases=SOFT, lower=-0.3, upper=-0.2, least=2).replace('"jkr"', '"given"')
    )
    files = ["--cases", str(tmp_path / "cases.toml"), "--gates", str(tmp_path / "gates.toml")]
    model = f"{tmp_path / 'noise.py'}:Noise"
    assert main(["run", *files, "--model", model, "--jobs", "1", "--quiet", "--out", str(tmp_path / "out")]) == 1
    found = verdicts(tmp_path / "out").set_index("gate")["verdict"]
    assert set(found["PADS"]) == {"PASS"}
    assert "FAIL" in set(found[["CARD-SAME-AGAIN"]])


BY_HEART = """
from comparisons import Result

KNOWN = {known}

class ByHeart:
    name = "by-heart"
    version = "1"
    citation = "none"
    domain = "everywhere"

    def evaluate(self, problem, quantity):
        # JKR where the gate asks, and nothing like it elsewhere.
        near = any(abs(problem.mu / mu - 1) < 1e-9 for mu in KNOWN)
        return Result(1.5 if near else 2.0, 0.0)
"""


PADS, _, _ = CASES.partition('[[grid]]\nid = "numbers"')


def with_model(run, tmp_path, text, cases=PADS):
    (tmp_path / "model.py").write_text(text)
    (tmp_path / "cases.toml").write_text(cases)
    gate = GATE.format(cases=SOFT, lower=-0.3, upper=-0.2, least=1).replace('"jkr"', '"given"')
    (tmp_path / "gates.toml").write_text(gate)
    files = ["--cases", str(tmp_path / "cases.toml"), "--gates", str(tmp_path / "gates.toml")]
    model = ["--model", f"{tmp_path / 'model.py'}:ByHeart", "--jobs", "1", "--quiet"]
    return main(["run", *files, *model, "--random", "6", "--out", str(tmp_path / "out")])


def test_a_model_that_knows_the_problems_by_heart_is_wrong_in_fresh_ones(run, tmp_path):
    stated = (problem_of(PAD.replace("2 MPa", E), tmp_path) for E in ("1 MPa", "2 MPa"))
    known = [problem.mu for problem in stated]
    assert with_model(run, tmp_path, BY_HEART.replace("{known}", str(known))) == 1
    found = verdicts(tmp_path / "out")
    assert set(found.loc[found["gate"] == "PADS", "verdict"]) == {"PASS"}
    fresh = found[(found["gate"] == "PADS-RANDOM") & found["problem"].notna()]
    assert len(fresh) == 6
    assert set(fresh["verdict"]) == {"FAIL"}
    # The fresh problems are between the stated ones, and none is one of them.
    values = [float(label.rpartition("=")[2].removesuffix(" Pa")) for label in fresh["problem"]]
    assert all(1e6 < value < 2e6 for value in values)
    # They are judged again from the folder alone.
    (tmp_path / "pad.toml").unlink()
    assert main(["judge", str(tmp_path / "out")]) == 1


EXACT = """
from comparisons import Result

class ByHeart:
    name = "by-heart"
    version = "1"
    citation = "none"
    domain = "everywhere"

    def evaluate(self, problem, quantity):
        return Result({value}, 0.0)
"""


def test_stored_results_of_an_external_model_are_evaluated_again_and_the_card_says_why_it_fails(run, tmp_path):
    options = ["--model", f"{tmp_path / 'model.py'}:ByHeart", "--jobs", "1", "--quiet", "--out", str(tmp_path / "out")]
    files = ["--cases", str(tmp_path / "cases.toml"), "--gates", str(tmp_path / "gates.toml")]
    assert with_model(run, tmp_path, EXACT.replace("{value}", "1.5"), PADS) == 0
    assert main(["run", *files, *options]) == 0
    record = json.loads((tmp_path / "out" / "run.json").read_text())
    again = record["evaluated_again"]["models"]["by-heart"]
    assert again["same"]
    assert all(task["problem"].startswith("pad.toml; ") for task in again["tasks"])


def test_the_card_says_why_a_model_fails_on_problems_of_files(run, tmp_path):
    assert with_model(run, tmp_path, EXACT.replace("{value}", "1.9"), PADS) == 1
    assert main(["report", str(tmp_path / "out")]) == 0
    assert "its error is beyond the limits in 8 of 8 cases" in (tmp_path / "out" / "report.html").read_text()


def test_problems_without_a_range_have_no_fresh_ones(run, tmp_path):
    cases = PADS.replace('vary = { "solid.E" = ["1 MPa", "2 MPa", "30 MPa"] }\n', "")
    known = problem_of(PAD, tmp_path).mu
    assert with_model(run, tmp_path, BY_HEART.replace("{known}", f"[{known}]"), cases) == 3
    found = verdicts(tmp_path / "out")
    assert found.loc[found["gate"] == "PADS-RANDOM", "verdict"].tolist() == ["INCONCLUSIVE"]


def problem_of(text, folder):
    (folder / "one.toml").write_text(text)
    return load_problem(folder / "one.toml")
