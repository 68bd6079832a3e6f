"""Verdicts that a model cannot get round: each kind of model has its own plain sentence."""

import re

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.domain import Domain
from comparisons.judging.decision import Verdict
from comparisons.judging.fresh_cases import draw
from comparisons.judging.gates import load_gates
from comparisons.judging.report_card import verdict_sentence
from comparisons.pipeline import inputs, report_cards
from comparisons.runs.cases import load_grids
from comparisons.runs.record import read_record

from . import conftest

GRID = conftest.GRID.replace("n = [2]", "n = [1, 2, 5]").replace("bradley", "dmt")
GATE = conftest.GATE.replace("bradley", "dmt")
DOMAIN = 'applies_to = {"quantities": ["pull_off_force"], "n": [1, 5], "k": [0, 0.4], "mu": [0.1, 1]}'
EXACT = """
if quantity != "pull_off_force":
    raise NotApplicable("no equation")
from comparisons.models.dmt import DMT
value = DMT().evaluate(problem, quantity).value
"""
TABLE = {1.0: 2.8803743, 2.0: 2.0, 5.0: 1.6694535}


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


def verdict_of(shown):
    """The verdict in the report card, on one line."""
    text = " ".join(re.sub(r"\n(?!   )", "|", shown.out).split())
    return re.search(r"\| verdict ([^|]*)", text)[1].strip()


def test_an_honest_model_passes_and_its_card_states_everything(run, write_model):
    spec = write_model(f"{EXACT}\nreturn Result(1.01 * value, 1e-12)", more=DOMAIN)
    status, shown, folder = run(spec, "--random", "4", "--seed", "7")
    assert status == 0, shown.err
    assert verdict_of(shown).startswith("PASS: it is within the limits in all 16 judged cases")
    text = " ".join(shown.out.split())
    for part in (
        "pull_off_force for 1 <= n <= 5, 0 <= k <= 0.4, 0.1 <= mu <= 1",
        "PASS, a value in 12 of 12",
        "PASS, a value in 4 of 4",
        "8 results are the same in a new process and in another order",
        "not those of the reference",
        "kept: 5 of 5 checks",
    ):
        assert part in text
    record = read_record(folder / "run.json")
    assert (record["arguments"]["random"], record["arguments"]["seed"]) == (4, 7)
    counts = {"asked": 12, "answered": 12, "not_applicable": 0, "failed": 0, "outside": 0}
    assert record["coverage"][0] == {"gate": "GIVEN", "candidate": "stranger", "verdict": "PASS"} | counts
    assert {"CARD-SAME-AGAIN", "CARD-DIFFERS", "GIVEN-RANDOM"} <= {one["gate"] for one in record["coverage"]}
    # The fresh cases are rows as others, are found again, and are the same again.
    assert len(pd.read_csv(folder / "results.csv")) == 2 * (12 + 4)
    status, again, _ = run(spec, "--random", "4", "--seed", "7")
    assert status == 0
    assert "0 computations" in again.err
    # A page and a new judgement have it, too, and nothing is computed for them.
    before = (folder / "verdicts.csv").read_bytes()
    assert main(["judge", str(folder)]) == 0
    assert (folder / "verdicts.csv").read_bytes() == before
    assert main(["report", str(folder)]) == 0
    assert "Report cards of the given models" in (folder / "report.html").read_text()


def drawn(domain, count=20, seed=1, gate=GATE, grid=GRID):
    """The fresh cases of a gate for a model that declares a domain."""
    domains = {"jkr": Domain.of(domain)} if domain else {}
    return draw(load_gates(gate), load_grids(grid), ["jkr"], domains, count, seed)


def cases_of(fresh):
    return [case for part in fresh.parts for case in part.grid.cases]


def test_another_seed_gives_other_cases():
    domain = {"quantities": ["pull_off_force"], "n": [2, 2], "k": [0.1, 0.4], "mu": [0.1, 100]}
    first, same, other = (cases_of(drawn(domain, 6, seed)) for seed in (1, 1, 2))
    assert first == same != other
    assert len(first) == 6
    assert all(case.n == 2 and 0.1 <= case.k <= 0.4 and 0.1 <= case.mu <= 10 for case in first)


def test_the_atlas_is_the_reference_of_fresh_cases_inside_its_box_and_the_full_model_outside():
    options = {"grid": GRID.replace('"dmt"', '"fscm"'), "gate": GATE.replace('"dmt"', '"fscm"')}
    domain = {"quantities": ["pull_off_force"], "n": [4, 8]}
    parts = drawn(domain, **options).parts
    assert [part.gate.reference for part in parts] == ["atlas", "fscm"]
    for part in parts:
        assert {case.n <= 6 and case.mu >= 0.01 for case in part.grid.cases} == {part.gate.reference == "atlas"}
    # The bound of the atlas is too large for narrow limits.
    narrow = options | {"gate": options["gate"].replace("0.1\nupper = 0.1", "0.001\nupper = 0.001")}
    assert [part.gate.reference for part in drawn(domain, **narrow).parts] == ["fscm"]


def test_a_gate_that_the_domain_does_not_meet_or_of_a_single_case_has_no_fresh_cases():
    fresh = drawn({"quantities": ["pull_off_force"], "mu": [50, 100]}, 5)
    assert (fresh.parts, fresh.undrawn) == ((), ())
    gate = GATE.replace("cases = {}", "cases = { n = [2, 2], k = [0.4, 0.4], mu = [1, 1] }").replace("= 2\n", "= 1\n")
    fresh = drawn(None, 5, gate=gate)
    assert (fresh.parts, fresh.undrawn) == ((), ())


def box(n, k, mu, width):
    """A table of a domain around a case."""
    ranges = {"k": [k * (1 - width), k * (1 + width)], "mu": [mu * (1 - width), mu * (1 + width)]}
    return {"quantities": ["pull_off_force"], "n": [n, n], **ranges}


STANDING = [(n, k, mu) for n in (1.0, 2.0, 5.0) for k in (0.0, 0.4) for mu in (0.1, 1.0)]
WIDE = {"quantities": ["pull_off_force"], "n": [1.2, 1.4], "k": [0.1, 0.3], "mu": [0.2, 0.5]}
FULL = {"quantities": ["pull_off_force"], "n": [1, 5], "k": [0, 0.4], "mu": [0.1, 1]}


@pytest.mark.parametrize(
    ("tables", "untested"),
    [
        ([box(*case, 0.0) for case in STANDING], 12),
        # At k = 0 fresh cases would fall on a rim of mu alone that is a few percent of the range.
        ([box(*case, 0.082) for case in STANDING], 6),
        # Room elsewhere is none beside the standing cases.
        ([*(box(*case, 0.0) for case in STANDING[1:]), WIDE], 11),
        ([box(2.0, 0.0, 0.1, 0.0), FULL | {"n": [5, 5]}], 1),
        ([{"quantities": ["pull_off_force"]}], 0),
        ([box(*case, 0.5) for case in STANDING], 0),
    ],
)
def test_standing_cases_without_room_beside_them_leave_a_gate_inconclusive(tables, untested):
    fresh = drawn(tables)
    assert [gate.gate for gate in fresh.undrawn] == ["GIVEN"] * bool(untested)
    assert all(f"{untested} of 12" in gate.reason for gate in fresh.undrawn)
    for case in cases_of(fresh):
        n, k, mu = min(STANDING, key=lambda known: abs(known[2] / case.mu - 1) + abs(known[1] - case.k))
        assert (abs(case.n - n) > 0.05) or (abs(case.k - k) > 0.005) or (abs(case.mu / mu - 1) > 0.05)


def test_a_box_with_many_standing_cases_gets_most_fresh_ones():
    tables = [*(WIDE | {"n": [1.2 + 0.01 * number] * 2} for number in range(19)), FULL]
    drawings = [cases_of(drawn(tables, 8, seed)) for seed in range(10)]
    assert {len(cases) for cases in drawings} == {8}
    counts = [sum(not 1.2 <= case.n <= 1.38 for case in cases) for cases in drawings]
    # 13 of 32 shares.
    assert 2 <= min(counts) <= max(counts) <= 5


NEAREST = f"""
if quantity != "pull_off_force":
    raise NotApplicable("no equation")
table = {TABLE}
return Result(table[min(table, key=lambda n: abs(n - problem.n))], 1e-6)
"""
NOISE = f"{EXACT}\nimport random\nreturn Result(value * (1 + 1e-3 * random.random()), 1e-12)"
STATE = f"""{EXACT}
last, self.last = getattr(self, "last", 0.0), value
return Result(value * (1 + 1e-6 * last), 1e-12)"""
POINTS = f"applies_to = {[box(*case, 0.0) for case in STANDING]}"


@pytest.mark.parametrize(
    ("body", "domain", "status", "verdict"),
    [
        (NEAREST, DOMAIN, 1, "FAIL: right at the standing cases and wrong between them"),
        (NEAREST, POINTS, 3, "INCONCLUSIVE: 12 of 12 standing cases"),
        (NOISE, DOMAIN, 1, "a random number or a clock"),
        (STATE, DOMAIN, 1, "it is another one when the evaluations come in another order"),
    ],
)
def test_what_seems_right_at_the_standing_cases_does_not_pass(run, write_model, body, domain, status, verdict):
    fresh = () if body in (NOISE, STATE) else ("--random", "5", "--seed", "1")
    found, shown, folder = run(write_model(body, more=domain), *fresh)
    assert found == status
    assert verdict in verdict_of(shown)
    assert main(["judge", str(folder)]) == status


def test_a_model_of_easy_cases_only_is_judged_by_its_coverage(run, write_model):
    body = f"""{EXACT}
if problem.n != 2 or problem.mu > 0.5:
    raise NotApplicable("too hard")
return Result(value, 1e-12)"""
    declared = 'applies_to = {"quantities": ["pull_off_force"], "n": [2, 2], "mu": [0.01, 0.5]}'
    # None, one that it keeps, and one that it does not keep.
    for name, domain, expected, coverage in (
        ("silent", "", 1, "2 of 12 (10 n/a)"),
        ("declared", declared, 0, "2 of 2 (10 outside)"),
        ("broken", DOMAIN.replace("[1, 5]", "[2, 2]"), 1, "2 of 4 (2 n/a, 8 outside)"),
    ):
        status, shown, _ = run(write_model(body, name, domain), out=name)
        assert status == expected
        assert coverage in " ".join(shown.out.split())
        assert expected == 0 or "the gate requires 90 %" in verdict_of(shown)
        # The digits of a closed form are stated and no more.
        assert expected or "2 of 2 values are those of dmt in every digit" in " ".join(shown.out.split())


def test_the_digits_of_a_numerical_reference_are_no_pass(run, write_model, monkeypatch):
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID.replace('"dmt"', '"atlas"')))
    body = EXACT.replace("comparisons.models.dmt import DMT", "comparisons.registry import create")
    body = body.replace("DMT()", 'create("atlas")') + "return Result(value * (1 + 1e-15 * (problem.n == 2)), 1e-6)"
    gate = GATE.replace('"dmt"', '"atlas"').replace("1e-6", "1e-3")
    status, shown, _ = run(write_model(body, more=DOMAIN), gate=gate)
    assert status == 3
    assert verdict_of(shown).startswith("INCONCLUSIVE: 8 of 12 values are those of atlas")


OTHERS = GATE.replace('id = "GIVEN"', 'id = "OTHERS"').replace('"given"', '"jkr"')


def test_a_run_without_a_gate_on_a_given_model_is_an_error(run, write_model, tmp_path):
    spec = write_model(f"{EXACT}\nreturn Result(1.01 * value, 1e-12)", more=f'{DOMAIN}\nlimits = ("jkr",)')
    status, shown, folder = run(spec, gate=OTHERS)
    assert status == 4
    assert verdict_of(shown) == "no gate was evaluated"
    assert read_record(folder / "run.json")["verdicts"]["all"] == "ERROR"
    assert main(["judge", str(folder)]) == 4
    # What check-model finds stands beside the verdict.
    status, shown, folder = run(spec, out="given")
    assert status == 0
    assert "not kept: is right in the limit jkr" in " ".join(shown.out.split())
    (tmp_path / "others.toml").write_text(OTHERS)
    assert main(["judge", str(folder), "--gates", str(tmp_path / "others.toml")]) == 4


def test_data_have_a_card_without_evaluations(run, write_data):
    rows = [f"pull_off_force,2,{k},{mu},2.0,1e-6" for k in (0, 0.4) for mu in (0.1, 1)]
    status, shown, _ = run(str(write_data(rows)))
    assert status == 0
    assert "a value in 4 of 4 (8 outside)" in shown.out
    assert "nothing: data do not change" in shown.out


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["--model", "jkr", "--random", "-1"], "--random -1"),
        (["--model", "jkr", "--random", "3", "--seed", "-1"], "--seed -1"),
        (["--model", "jkr", "--seed", "1"], "--random N"),
        (["--random", "3"], "--random needs --model"),
    ],
)
def test_wrong_options_are_one_sentence(arguments, named, tmp_path, capsys):
    assert main(["run", "--out", str(tmp_path / "out"), *arguments]) == 2
    assert named in capsys.readouterr().err


def test_the_sentence_of_each_verdict_names_the_first_reason():
    row = dict.fromkeys(("n", "k", "mu", "error", "reason", "status", "gate"), None) | {"candidate": "mine"}
    passed = row | {"gate": "A", "error": 0.01, "n": 2.0, "verdict": Verdict.PASS, "status": "ok", "reason": ""}
    failed = passed | {"error": 0.3, "verdict": Verdict.FAIL}
    broken = row | {"gate": "A", "verdict": Verdict.ERROR, "reason": "mine has no row", "status": "missing"}
    beyond = verdict_sentence("mine", pd.DataFrame([passed, failed]))
    assert beyond == "FAIL: its error is beyond the limits in 1 of 2 cases, at worst 0.3 in A"
    assert verdict_sentence("mine", pd.DataFrame([failed, broken])) == "ERROR: mine has no row"
    assert verdict_sentence("other", pd.DataFrame([passed])) == "no gate was evaluated"


def test_what_takes_as_long_as_the_model_does_is_announced_where_no_bar_is_shown(monkeypatch, capsys):
    monkeypatch.setattr(report_cards, "_card", lambda identity, rows, exact, cases: {})
    assert report_cards.make_cards({"mine": None}, [], [], {}) == {"mine": {}}
    assert "checking mine" in capsys.readouterr().err
