"""Verdicts that a model cannot get round: each kind of model has its own plain sentence."""

import re
from xml.etree import ElementTree

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.domain import Domain
from comparisons.external.model_source import close_models
from comparisons.judging.decision import Verdict
from comparisons.judging.fresh_cases import draw
from comparisons.judging.gates import load_gates
from comparisons.judging.report_card import verdict_sentence
from comparisons.pipeline import inputs, report_cards
from comparisons.runs.cases import load_grids
from comparisons.runs.record import read_record
from comparisons.runs.tables import read_table

GRID = """
[[grid]]
id = "cases"
title = "Cases of a model"
tier = "quick"
reference = "dmt"
models = ["jkr"]
quantities = ["pull_off_force"]
n = [1, 2, 5]
k = [0, 0.4]
mu = [0.1, 1]
"""
GATE = """
[[gate]]
id = "GIVEN"
requirement = "The model has the pull-off force of DMT."
quantity = "pull_off_force"
candidate = "given"
reference = "dmt"
cases = {}
metric = "rel"
lower = -0.1
upper = 0.1
max_reference_uncertainty = 1e-6
basis = "derived"
grounds = "a gate of this test"
min_cases = 2
min_coverage = 0.9
tier = "quick"
not_applicable = "leave-out"
"""
DOMAIN = 'applies_to = {"quantities": ["pull_off_force"], "n": [1, 5], "k": [0, 0.4], "mu": [0.1, 1]}'
EXACT = """
if quantity != "pull_off_force":
    raise NotApplicable("no equation")
from comparisons.models.dmt import DMT
value = DMT().evaluate(problem, quantity).value
"""
TABLE = {1.0: 2.8803743, 2.0: 2.0, 5.0: 1.6694535}


@pytest.fixture(autouse=True)
def wide(monkeypatch):
    """No sentence is folded."""
    monkeypatch.setattr("comparisons.cli.options._WIDTH", 1000)


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Return a function that runs a model in the cases above; it returns status, output and folder."""
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID))
    (tmp_path / "gates").mkdir()

    def called(spec, *arguments, out="out", gate=GATE):
        (tmp_path / "gates" / "gates.toml").write_text(gate)
        folder = tmp_path / "runs" / out
        options = ["--jobs", "1", "--out", str(folder), "--gates", str(tmp_path / "gates" / "gates.toml")]
        status = main(["run", "--verbose", *options, "--model", spec, *arguments])
        return status, capsys.readouterr(), folder

    return called


def sentence(shown):
    """The verdict in the report card, on one line."""
    lines = shown.out.splitlines()
    start = next(number for number, line in enumerate(lines) if line.startswith("  verdict "))
    end = next(number for number, line in enumerate(lines) if number > start and not line.startswith("   "))
    return " ".join(" ".join(lines[start:end]).split()).removeprefix("verdict ")


def test_an_honest_model_passes_and_its_card_states_everything(run, write_model):
    status, shown, folder = run(
        write_model(f"{EXACT}\nreturn Result(1.01 * value, 1e-12)", more=DOMAIN), "--random", "4", "--seed", "7"
    )
    assert status == 0, shown.err
    assert sentence(shown) == "PASS: it is within the limits in all 16 judged cases"
    for text in (
        "pull_off_force for 1 <= n <= 5, 0 <= k <= 0.4, 0.1 <= mu <= 1",
        "PASS, a value in 12 of 12",
        "PASS, a value in 4 of 4",
        "8 results are the same in a new process and in another order",
        "not those of the reference",
        "kept: 5 of 5 checks",
    ):
        assert text in shown.out
    record = read_record(folder / "run.json")
    assert (record["arguments"]["random"], record["arguments"]["seed"]) == (4, 7)
    assert record["coverage"][0] == {
        "gate": "GIVEN",
        "candidate": "stranger",
        "verdict": "PASS",
        "asked": 12,
        "answered": 12,
        "not_applicable": 0,
        "failed": 0,
        "outside": 0,
    }
    assert {"CARD-SAME-AGAIN", "CARD-DIFFERS", "GIVEN-RANDOM"} <= {one["gate"] for one in record["coverage"]}
    # The fresh cases are rows as others, are found again, and are the same again.
    rows = pd.read_csv(folder / "results.csv")
    assert set(rows["model"]) == {"stranger", "dmt"}
    assert len(rows) == 2 * (12 + 4)
    status, again, _ = run(str(folder.parent.parent / "stranger.py:Model"), "--random", "4", "--seed", "7")
    assert status == 0
    assert "0 computations" in again.err
    # A page, JUnit and a new judgement have it, too, and nothing is computed for them.
    before = (folder / "verdicts.csv").read_bytes()
    assert main(["judge", str(folder)]) == 0
    assert (folder / "verdicts.csv").read_bytes() == before
    assert main(["report", str(folder)]) == 0
    assert "Report cards of the given models" in (folder / "report.html").read_text()
    suite = ElementTree.parse(folder / "junit.xml").find("testsuite[@name='GIVEN']/properties")
    assert {one.get("name"): one.get("value") for one in suite}["stranger answered"] == "12"


def test_another_seed_gives_other_cases():
    grids, gates = load_grids(GRID), load_gates(GATE)
    domain = Domain.of({"quantities": ["pull_off_force"], "n": [2, 2], "k": [0.1, 0.4], "mu": [0.1, 100]})
    drawn = [draw(gates, grids, ["jkr"], {"jkr": domain}, 6, seed).parts[0].grid.cases for seed in (1, 1, 2)]
    assert drawn[0] == drawn[1]
    assert drawn[0] != drawn[2]
    assert len(drawn[0]) == 6
    for case in drawn[0]:
        assert case.n == 2
        assert 0.1 <= case.k <= 0.4
        assert 0.1 <= case.mu <= 10


def test_the_atlas_is_the_reference_of_fresh_cases_inside_its_box_and_the_full_model_outside():
    grids = load_grids(GRID.replace('"dmt"', '"fscm"'))
    gate = GATE.replace('"dmt"', '"fscm"')
    domain = {"jkr": Domain.of({"quantities": ["pull_off_force"], "n": [4, 8]})}
    parts = draw(load_gates(gate), grids, ["jkr"], domain, 20, 1).parts
    assert [part.gate.reference for part in parts] == ["atlas", "fscm"]
    for part in parts:
        assert {case.n <= 6 and case.mu >= 0.01 for case in part.grid.cases} == {part.gate.reference == "atlas"}
    # The bound of the atlas is too large for narrow limits.
    narrow = gate.replace("0.1\nupper = 0.1", "0.001\nupper = 0.001")
    assert [part.gate.reference for part in draw(load_gates(narrow), grids, ["jkr"], domain, 20, 1).parts] == ["fscm"]


def test_a_gate_that_the_domain_does_not_meet_has_no_fresh_cases(capsys):
    domain = {"jkr": Domain.of({"quantities": ["pull_off_force"], "mu": [50, 100]})}
    assert draw(load_gates(GATE), load_grids(GRID), ["jkr"], domain, 5, 1).parts == ()
    assert "GIVEN has no fresh cases: the domain of jkr" in capsys.readouterr().err


def box(n, k, mu, width):
    """A table of a domain around a case."""
    ranges = {"k": [k * (1 - width), k * (1 + width)], "mu": [mu * (1 - width), mu * (1 + width)]}
    return {"quantities": ["pull_off_force"], "n": [n, n], **ranges}


STANDING = [(n, k, mu) for n in (1.0, 2.0, 5.0) for k in (0.0, 0.4) for mu in (0.1, 1.0)]
WIDE = {"quantities": ["pull_off_force"], "n": [1.2, 1.4], "k": [0.1, 0.3], "mu": [0.2, 0.5]}


@pytest.mark.parametrize(
    ("tables", "untested"),
    [
        ([box(*case, 0.0) for case in STANDING], 12),
        ([box(*case, 1e-3) for case in STANDING], 12),
        # At k = 0 fresh cases would fall on a rim of mu alone that is a few percent of the range.
        ([box(*case, 0.082) for case in STANDING], 6),
        # Room elsewhere is none beside the standing cases.
        ([*(box(*case, 0.0) for case in STANDING[1:]), WIDE], 11),
        ([box(2.0, 0.0, 0.1, 0.0), {"quantities": ["pull_off_force"], "n": [5, 5], "k": [0, 0.4], "mu": [0.1, 1]}], 1),
        ([{"quantities": ["pull_off_force"]}], 0),
        ([{"quantities": ["pull_off_force"], "n": [2, 2], "k": [0, 0]}], 0),
        ([box(*case, 0.5) for case in STANDING], 0),
    ],
)
def test_standing_cases_without_room_beside_them_leave_a_gate_inconclusive(tables, untested):
    fresh = draw(load_gates(GATE), load_grids(GRID), ["jkr"], {"jkr": Domain.of(tables)}, 20, 1)
    assert [gate.gate for gate in fresh.undrawn] == ["GIVEN"] * bool(untested)
    assert all(f"{untested} of 12" in gate.reason for gate in fresh.undrawn)
    for case in [case for part in fresh.parts for case in part.grid.cases]:
        n, k, mu = min(STANDING, key=lambda known: abs(known[2] / case.mu - 1) + abs(known[1] - case.k))
        assert (abs(case.n - n) > 0.05) or (abs(case.k - k) > 0.005) or (abs(case.mu / mu - 1) > 0.05)


def test_a_box_with_many_standing_cases_gets_most_fresh_ones():
    narrow = [WIDE | {"n": [1.2 + 0.01 * number] * 2} for number in range(19)]
    tables = [*narrow, {"quantities": ["pull_off_force"], "n": [1, 5], "k": [0, 0.4], "mu": [0.1, 1]}]
    counts = []
    for seed in range(10):
        fresh = draw(load_gates(GATE), load_grids(GRID), ["jkr"], {"jkr": Domain.of(tables)}, 8, seed)
        cases = [case for part in fresh.parts for case in part.grid.cases]
        assert len(cases) == 8
        counts.append(sum(not 1.2 <= case.n <= 1.38 for case in cases))
    # 13 of 32 shares.
    assert 2 <= min(counts) <= max(counts) <= 5


def test_a_gate_of_a_single_case_has_no_fresh_cases(capsys):
    gate = GATE.replace("cases = {}", "cases = { n = [2, 2], k = [0.4, 0.4], mu = [1, 1] }").replace("= 2\n", "= 1\n")
    fresh = draw(load_gates(gate), load_grids(GRID), ["jkr"], {}, 5, 1)
    assert (fresh.parts, fresh.undrawn) == ((), ())


def test_a_table_whose_domain_is_its_points_is_inconclusive(run, write_model):
    domain = f"applies_to = {[box(*case, 0.0) for case in STANDING]}"
    spec = write_model(NEAREST, more=domain)
    assert run(spec, out="standing")[0] == 0
    status, shown, folder = run(spec, "--random", "6", "--seed", "1")
    assert status == 3
    assert sentence(shown).startswith("INCONCLUSIVE: 12 of 12 standing cases")
    assert main(["judge", str(folder)]) == 3
    assert {one["gate"]: one["verdict"] for one in read_record(folder / "run.json")["coverage"]}["GIVEN-RANDOM"] == (
        "INCONCLUSIVE"
    )


NEAREST = f"""
if quantity != "pull_off_force":
    raise NotApplicable("no equation")
table = {TABLE}
return Result(table[min(table, key=lambda n: abs(n - problem.n))], 1e-6)
"""


def test_a_table_of_the_standing_cases_is_right_there_alone(run, write_model):
    spec = write_model(NEAREST, more=DOMAIN)
    status, shown, folder = run(spec, "--random", "6", "--seed", "1")
    assert status == 1
    # Without fresh cases it would pass.
    assert re.search("GIVEN +PASS, a value in 12 of 12", shown.out)
    assert sentence(shown).startswith("FAIL: right at the standing cases and wrong between them: the error is at most ")
    assert "standing cases and" in sentence(shown)
    assert main(["judge", str(folder)]) == 1


def test_a_table_that_refuses_everything_else_is_found_by_its_refusals(run, write_model):
    body = f"""
if quantity != "pull_off_force" or problem.n not in {TABLE}:
    raise NotApplicable("not in the table")
return Result({TABLE}[problem.n], 1e-6)
"""
    status, shown, _ = run(write_model(body), "--random", "5", "--seed", "1")
    assert status == 1
    assert "FAIL: it has a value in 12 standing cases, and in 0 of the 5 fresh ones" in sentence(shown) or (
        "has a value in 0 of the 5 cases" in sentence(shown)
    )


def test_a_small_error_between_exact_standing_cases_is_no_pass(run, write_model):
    """A curve through the standing values: within the limits everywhere, but not as good as it seems."""
    body = f"{EXACT}\nreturn Result(value * (1 + 0.02 * (problem.n - 1) * (problem.n - 2) * (problem.n - 5)), 1e-12)"
    status, shown, _ = run(write_model(body, more=DOMAIN), "--random", "6", "--seed", "1")
    assert status == 1
    assert "wrong between them" in sentence(shown)


def test_a_model_of_easy_cases_only_is_judged_by_its_coverage(run, write_model):
    body = f"""{EXACT}
if problem.n != 2 or problem.mu > 0.5:
    raise NotApplicable("too hard")
return Result(value, 1e-12)"""
    status, shown, _ = run(write_model(body))
    assert status == 1
    assert sentence(shown) == (
        "FAIL: stranger has a value in 2 of the 12 cases in which it is evaluated; the gate requires 90 % (a model "
        "that is not for all of them declares its domain)"
    )
    assert "2 of 12 (10 n/a)" in shown.out
    # With a declared domain that it keeps it is judged in that.
    declared = 'applies_to = {"quantities": ["pull_off_force"], "n": [2, 2], "mu": [0.01, 0.5]}'
    status, shown, _ = run(write_model(body, "declared", declared), out="declared")
    assert status == 0
    assert "2 of 2 (10 outside)" in shown.out
    # With one that it does not keep it fails.
    status, shown, _ = run(write_model(body, "broken", DOMAIN.replace("[1, 5]", "[2, 2]")), out="broken")
    assert status == 1
    assert "2 of 4 (2 n/a, 8 outside)" in shown.out


def test_noise_is_found_and_named(run, write_model):
    body = f"{EXACT}\nimport random\nreturn Result(value * (1 + 1e-3 * random.random()), 1e-12)"
    status, shown, folder = run(write_model(body, more=DOMAIN))
    assert status == 1
    assert sentence(shown) == (
        "FAIL: it gives another number when it is evaluated again: a random number or a clock: even the first "
        "evaluation of a new process gives another number"
    )
    assert main(["judge", str(folder)]) == 1


def test_state_is_found_and_named(run, write_model):
    body = f"""{EXACT}
last, self.last = getattr(self, "last", 0.0), value
return Result(value * (1 + 1e-6 * last), 1e-12)"""
    status, shown, _ = run(write_model(body, more=DOMAIN))
    assert status == 1
    assert sentence(shown) == (
        "FAIL: it gives another number when it is evaluated again: the result depends on earlier evaluations: it is "
        "another one when the evaluations come in another order"
    )


@pytest.mark.parametrize(("differs", "expected"), [("False", 3), ("problem.n == 2", 3), ("True", 0)])
def test_the_digits_of_a_numerical_reference_are_no_pass(run, write_model, monkeypatch, differs, expected):
    """Those of the rows that are stored: another process may round the last digit otherwise."""
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID.replace('"dmt"', '"atlas"')))
    gate = GATE.replace('"dmt"', '"atlas"').replace("1e-6", "1e-3")
    _, _, folder = run("jkr", gate=gate)
    stored = read_table(folder / "results.parquet").query("model == 'atlas'")
    values = {(row.n, row.k, row.mu): row.value for row in stored.itertuples()}
    text = f"""
if quantity != "pull_off_force":
    raise NotApplicable("no equation")
value = {values}[problem.n, problem.k, problem.mu]
return Result(value * (1.0 + 1e-15 * ({differs})), 1e-6)
"""
    status, shown, folder = run(write_model(text, more=DOMAIN), gate=gate)
    assert status == expected
    record = read_record(folder / "run.json")
    (digits,) = [one["verdict"] for one in record["coverage"] if one["gate"] == "CARD-DIFFERS"]
    assert digits == ("INCONCLUSIVE" if expected else "PASS")
    assert sentence(shown).startswith(digits)
    close_models()
    assert main(["judge", str(folder)]) == expected


def test_the_digits_of_a_closed_form_are_stated_and_no_more(run, write_model):
    status, shown, _ = run(write_model(f"{EXACT}\nreturn Result(value, 1e-12)", more=DOMAIN))
    assert status == 0
    assert "12 of 12 values are those of dmt in every digit" in shown.out


OTHERS = GATE.replace('id = "GIVEN"', 'id = "OTHERS"').replace('"given"', '"jkr"')


def test_a_run_without_a_gate_on_a_given_model_is_an_error(run, write_model):
    spec = write_model(f"{EXACT}\nreturn Result(1.01 * value, 1e-12)", more=DOMAIN)
    status, shown, folder = run(spec, gate=OTHERS)
    assert status == 4
    assert "judged cases" not in shown.out
    assert sentence(shown) == "no gate was evaluated"
    assert read_record(folder / "run.json")["verdicts"]["all"] == "ERROR"
    assert main(["judge", str(folder)]) == 4
    assert main(["report", str(folder)]) == 0
    assert "No gate was evaluated" in (folder / "report.html").read_text()


def test_other_gates_on_no_given_model_are_an_error_of_a_new_judgement(run, write_model, tmp_path):
    status, _, folder = run(write_model(f"{EXACT}\nreturn Result(1.01 * value, 1e-12)", more=DOMAIN))
    assert status == 0
    (tmp_path / "others.toml").write_text(OTHERS)
    assert main(["judge", str(folder), "--gates", str(tmp_path / "others.toml")]) == 4


def test_a_model_without_a_gate_beside_one_with_a_gate_has_no_verdict(run, write_model):
    spec = write_model(f"{EXACT}\nreturn Result(1.01 * value, 1e-12)", more=DOMAIN)
    status, shown, _ = run(spec, "dmt-strength", gate=GATE.replace('"given"', '"dmt-strength"'))
    assert status != 4
    assert sentence(shown) == "no gate was evaluated"


def test_what_check_model_finds_stands_beside_the_verdict(run, write_model):
    status, shown, _ = run(write_model(f"{EXACT}\nreturn Result(value, 1e-12)", more='limits = ("jkr",)'))
    assert status == 0
    assert "not kept: is right in the limit jkr" in " ".join(shown.out.split())


def test_data_have_a_card_without_evaluations(run, write_data):
    rows = [f"pull_off_force,2,{k},{mu},2.0,1e-6" for k in (0, 0.4) for mu in (0.1, 1)]
    status, shown, _ = run(str(write_data(rows)))
    assert "a value in 4 of 4 (8 outside)" in shown.out
    assert "nothing: data do not change" in shown.out
    assert status == 0
    # Its domain is a list of cases.
    status, shown, _ = run(str(write_data(rows)), "--random", "3", out="fresh")
    assert status == 3
    assert sentence(shown).startswith("INCONCLUSIVE: 12 of 12 standing cases")


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--model", "jkr", "--random", "-1"], "--random -1 is outside 0 to 10000"),
        (["--model", "jkr", "--random", "3", "--seed", "-1"], "--seed -1 is outside 0 to"),
        (["--model", "jkr", "--seed", "1"], "--seed 1 is for the fresh cases of --random N, which is missing"),
        (["--random", "3"], "--random needs --model"),
    ],
)
def test_wrong_options_are_one_sentence(arguments, sentence, tmp_path, capsys):
    assert main(["run", "--out", str(tmp_path / "out"), *arguments]) == 2
    assert sentence in capsys.readouterr().err


def test_the_sentence_of_each_verdict_names_the_first_reason():
    row = dict.fromkeys(("n", "k", "mu", "error", "reason", "status", "gate"), None) | {"candidate": "mine"}
    passed = row | {"gate": "A", "error": 0.01, "n": 2.0, "verdict": Verdict.PASS, "status": "ok", "reason": ""}
    failed = passed | {"error": 0.3, "verdict": Verdict.FAIL}
    broken = row | {"gate": "A", "verdict": Verdict.ERROR, "reason": "mine has no row", "status": "missing"}
    table = pd.DataFrame([passed, failed])
    assert verdict_sentence("mine", table) == "FAIL: its error is beyond the limits in 1 of 2 cases, at worst 0.3 in A"
    assert verdict_sentence("mine", pd.DataFrame([failed, broken])) == "ERROR: mine has no row"
    assert verdict_sentence("other", table) == "no gate was evaluated"


def test_what_takes_as_long_as_the_model_does_is_announced_where_no_bar_is_shown(monkeypatch, capsys):
    monkeypatch.setattr(report_cards, "_card", lambda identity, rows, exact, cases: {})
    assert report_cards.make_cards({"mine": None}, [], [], {}) == {"mine": {}}
    shown = capsys.readouterr().err
    assert shown == "checking mine: some results are evaluated again in a new process, and check-model is called\n"
