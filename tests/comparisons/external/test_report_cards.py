"""Verdicts that a model cannot get round: each kind of model has its own plain sentence."""

from dataclasses import replace
from xml.etree import ElementTree

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.domain import Domain
from comparisons.external.contract_checks import Finding
from comparisons.external.model_source import close_models
from comparisons.judging.fresh_cases import draw
from comparisons.judging.gates import load_gates
from comparisons.judging.report_card import card_lines
from comparisons.pipeline import inputs, report_cards
from comparisons.pipeline.run import _named, run
from comparisons.problem import Problem
from comparisons.registry import create
from comparisons.runs.cases import load_grids
from comparisons.runs.record import read_record

from . import conftest

GRID = conftest.GRID.replace("n = [2]", "n = [1, 2, 5]").replace("bradley", "dmt")
GATE = conftest.GATE.replace("bradley", "dmt")


def drawn(domain, count=20, seed=1, gate=GATE, grid=GRID):
    """The fresh cases of a gate for a model that declares a domain."""
    taken = {"jkr": Domain.of(domain)} if domain else {}
    return draw(load_gates(gate), load_grids(grid), ["jkr"], taken, count, seed)


def cases_of(fresh):
    return [case for part in fresh.parts for case in part.grid.cases]


def test_another_seed_gives_other_cases():
    domain = {"quantities": ["pull_off_force"], "n": [2, 2], "k": [0.1, 0.4], "mu": [0.1, 100]}
    drawn_once, same, drawn_otherwise = (cases_of(drawn(domain, 6, seed)) for seed in (1, 1, 2))
    assert drawn_once == same != drawn_otherwise
    assert len(drawn_once) == 6
    assert all(case.n == 2 and 0.1 <= case.k <= 0.4 and 0.1 <= case.mu <= 10 for case in drawn_once)


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


def test_without_a_domain_cases_are_between_the_standing_ones_and_poissons_ratio_is_left_to_the_models():
    assert all(1 <= case.n <= 5 and case.k <= 0.4 and 0.1 <= case.mu <= 1 for case in cases_of(drawn(None)))
    fresh = cases_of(drawn(None, 5, grid=GRID.replace("mu = [0.1, 1]", "mu = [0.1, 1]\nnu = [0, 0.3]")))
    assert [*map(set, (case.parameters for case in fresh))] == [{"n", "k", "mu"}] * 5


@pytest.mark.parametrize(
    ("model", "quantity", "limits"),
    [
        ("jkr", "pull_off_force", {"n": (0.8, 10), "k": (0, 0.8), "mu": (0.005, 10)}),
        ("schwarz", "pull_off_force", {"n": (2, 2), "k": (0, 0), "mu": (0.005, 10)}),
        ("semi-rigid", "jump_in_gap", {"n": (0.8, 10), "k": (0, 0.8), "mu": (0.2, 10)}),
    ],
)
def test_fresh_cases_of_our_models_are_among_those_that_they_take(model, quantity, limits):
    """Over the whole reach of the parameters in which the standing cases that they take differ."""
    gate, grid = (text.replace("pull_off_force", quantity) for text in (GATE, GRID))
    grid = grid.replace("mu = [0.1, 1]", "mu = [0.1, 1, 5]")
    taken = create(model)
    fresh = draw(load_gates(gate), load_grids(grid), [model], {model: taken}, 40, 1)
    cases = cases_of(fresh)
    assert len(cases) >= 20
    assert all(taken.skip(case, quantity) is None for case in cases)
    for name, (low, high) in limits.items():
        values = [case.numbers[name] for case in cases]
        assert low <= min(values) <= max(values) <= high
        assert max(values) - min(values) >= 0.7 * (high - low)
    # Between the standing ones there would be none beyond mu = 5.
    assert max(case.mu for case in cases) > 5


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
    assert [gate["gate"] for gate in fresh.undrawn] == ["GIVEN"] * bool(untested)
    assert all(f"{untested} of 12" in gate["reason"] for gate in fresh.undrawn)
    for case in cases_of(fresh):
        n, k, mu = min(STANDING, key=lambda numbers: abs(numbers[2] / case.mu - 1) + abs(numbers[1] - case.k))
        assert (abs(case.n - n) > 0.05) or (abs(case.k - k) > 0.005) or (abs(case.mu / mu - 1) > 0.05)


def test_every_table_with_standing_cases_gets_a_fresh_one_or_counts_as_untested():
    """Not one table of a wide domain that has none."""
    tables = [box(*case, 0.5) for case in STANDING]
    for count, seed in ((5, 1), (5, 2), (12, 3), (20, 4)):
        fresh = drawn([*tables, WIDE | {"n": [1.2, 1.2]}], count, seed)
        assert len(cases_of(fresh)) == count
        untested = max(12 - count, 0)
        assert [entry["reason"].split()[:3] for entry in fresh.undrawn] == [[str(untested), "of", "12"]] * bool(
            untested
        )
    # One point among wide tables: the others share its cases.
    fresh = drawn([box(2.0, 0.4, 0.1, 0.0), *tables[:3]], 3)
    assert len(cases_of(fresh)) == 3
    assert [entry["reason"].partition(" standing")[0] for entry in fresh.undrawn] == ["1 of 12"]


def test_a_box_with_many_standing_cases_gets_most_fresh_ones():
    tables = [*(WIDE | {"n": [1.2 + 0.01 * number] * 2} for number in range(19)), FULL]
    drawings = [cases_of(drawn(tables, 8, seed)) for seed in range(4)]
    assert {len(cases) for cases in drawings} == {8}
    counts = [sum(not 1.2 <= case.n <= 1.38 for case in cases) for cases in drawings]
    # 13 of 32 shares.
    assert 2 <= min(counts) <= max(counts) <= 5


#: The rigid pull-off force, which is that of DMT.
EXACT = """
if quantity != "pull_off_force":
    raise NotApplicable("no equation")
def force(n):
    b = 2 / n
    base = math.prod((j - 1) / (j - b) for j in range(4, 10))
    return 32 / (9 * n - 2) * n**b * math.gamma(3 - b) * math.gamma(b) / 2 * base ** ((3 - b) / 6)
value = force(problem.n)
"""
NEAREST = f"{EXACT}\nreturn Result(force(min((1, 2, 5), key=lambda n: abs(n - problem.n))), 1e-6)"
NOISE = f"{EXACT}\nimport random\nreturn Result(value * (1 + 1e-3 * random.random()), 1e-12)"
STATE = f"{EXACT}\nself.last = value + 1e-6 * getattr(self, 'last', 0.0)\nreturn Result(self.last, 1e-12)"
HONEST = f"{EXACT}\nreturn Result(1.01 * value, 1e-12)"
DOMAIN = f"applies_to = {FULL}"
PART = 'applies_to = {"quantities": ["pull_off_force"], "n": [2, 2], "mu": [0.01, 0.5]}'

#: Name -> its body and domain; how its verdict begins; what is in its card.
MODELS = {
    "honest": (HONEST, DOMAIN, "PASS: it is within the limits in all", "a value in 12 of 12"),
    "nearest": (NEAREST, DOMAIN, "FAIL: right at the standing cases and wrong between them", "a value in 12 of 12"),
    "noise": (NOISE, DOMAIN, "FAIL: a random number or a clock", "a clock"),
    "state": (STATE, DOMAIN, "FAIL: the result depends on earlier", "come in another order"),
    # The digits of a closed form are stated and no more.
    "same": (f"{EXACT}\nreturn Result(value, 0.0)", PART, "PASS: ", "2 of 2 values are those of dmt in every digit"),
}


def leave_out_processes(patch):
    """Examine no model, and evaluate only those again whose verdict may change by that."""
    card = report_cards._card
    patch.setattr(report_cards, "examine", lambda model: [Finding("is of the right size", "wrong", "it is not")])

    def card_of_some(identity, rows, *more):
        evaluated = rows[0].model in ("honest", "noise", "state")
        return card(identity, rows, *more) if evaluated else {"kind": "code", "check_model": []}

    patch.setattr(report_cards, "_card", card_of_some)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The run of all these models, and the gates file and the folder."""
    folder = tmp_path_factory.mktemp("cards")
    (folder / "models").mkdir()
    specs = [conftest.model_file(folder / "models", body, name, more) for name, (body, more, *_) in MODELS.items()]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(inputs, "grids", lambda tier: load_grids(GRID))
        with pytest.MonkeyPatch.context() as during_the_run:
            leave_out_processes(during_the_run)
            judgement = run("quick", GATE, specs, folder / "out", random=5, seed=1).judgement
        yield judgement
        close_models()


def lines_of(judgement, name):
    domain = judgement.inputs.domains.get(name)
    return dict(card_lines(name, judgement.verdicts, judgement.checks, judgement.cards[name], domain))


@pytest.mark.parametrize("name", MODELS)
def test_each_kind_of_model_has_its_verdict(finished, name):
    *_, verdict, piece = MODELS[name]
    lines = lines_of(finished, name)
    assert lines["verdict"].startswith(verdict), lines
    assert piece in str(lines)
    if name == "honest":
        assert "a value in 5 of 5" in lines["GIVEN-RANDOM"]
        assert lines["evaluated again"].startswith("8 results are the same")
        # What check-model finds stands beside the verdict.
        assert lines["check-model"] == "kept: 0 of 1 checks; not kept: is of the right size: it is not"


def test_a_model_that_does_not_repeat_its_values_fails_wherever_verdicts_are_read(finished):
    verdicts = finished.verdicts.query("candidate == 'noise' and verdict == 'PASS'")
    of_one = replace(finished, verdicts=verdicts, cards={"noise": finished.cards["noise"]})
    assert len(of_one.verdicts) >= 12
    assert str(of_one.verdict) == "FAIL"
    assert {(name, verdict) for name, verdict, _ in _named(of_one) if "GIVEN" not in name} == {
        ("evaluated again[noise]", "FAIL"),
        ("digits[noise]", "PASS"),
    }
    failures = [
        case.get("name")
        for case in ElementTree.parse(finished.folder / "junit.xml").iter("testcase")
        if case.find("failure") is not None
    ]
    assert {"noise evaluated again", "state evaluated again"} <= {*failures}


def test_the_record_has_coverage_and_fresh_cases_and_a_new_judgement_is_the_same(finished):
    record = read_record(finished.folder / "run.json")
    assert (record["fresh"]["count"], record["fresh"]["seed"]) == (5, 1)
    counts = {"asked": 12, "answered": 12, "not_applicable": 0, "failed": 0, "outside": 0}
    assert {"gate": "GIVEN", "candidate": "honest", "verdict": "PASS"} | counts in record["coverage"]
    # The checks of the cards are no rows of the verdicts.
    assert {row["gate"] for row in record["coverage"]} == {"GIVEN", "GIVEN-RANDOM"}
    rows = pd.read_csv(finished.folder / "results.csv")
    assert (rows["model"] == "honest").sum() == 12 + 5
    before = (finished.folder / "verdicts.csv").read_bytes()
    assert main(["judge", str(finished.folder)]) == 1
    assert (finished.folder / "verdicts.csv").read_bytes() == before
    assert main(["report", str(finished.folder)]) == 0
    assert "Report cards of the given models" in (finished.folder / "report.html").read_text()


def test_the_digits_of_a_numerical_reference_are_no_pass_and_data_are_not_evaluated_again(
    tmp_path, monkeypatch, write_data
):
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID.replace('"dmt"', '"atlas"')))
    atlas, factors = create("atlas"), (1.0, 1.0, 1.0, 1.01)
    forces = [atlas.evaluate(Problem.dimensionless(*case), "pull_off_force").value for case in STANDING[4:8]]
    rows = [
        f"pull_off_force,2,{k},{mu},{factor * force!r},1e-6"
        for (_, k, mu), factor, force in zip(STANDING[4:8], factors, forces, strict=True)
    ]
    gate = GATE.replace('"dmt"', '"atlas"').replace("1e-6", "1e-3")
    judgement = run("quick", gate, [str(write_data(rows))], tmp_path / "runs", random=5).judgement
    lines = lines_of(judgement, "measured")
    assert "a value in 4 of 4 (8 outside)" in lines["GIVEN"]
    assert lines["evaluated again"] == "nothing: data do not change"
    # There is no room for fresh cases beside those of the data.
    assert lines["GIVEN-RANDOM"].startswith("INCONCLUSIVE")
    assert lines["verdict"].startswith("INCONCLUSIVE: ")
    assert "3 of 4 values are those of atlas" in lines["verdict"]
