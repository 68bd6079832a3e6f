"""Gates: files that are read, files that are refused, and the standing gates."""

import json
import math
import re
from dataclasses import fields
from importlib.resources import files

import pytest

from comparisons.cli.main import main
from comparisons.judging.gates import GIVEN, METRICS, Gate, gates_text, load_gates, of_tier
from comparisons.problem import Problem
from comparisons.registry import MODELS
from comparisons.runs.cases import TIERS, Grid, grids

GATE = """
[[gate]]
id = "A-GATE"
requirement = "JKR is right."
quantity = "pull_off_force"
candidate = "jkr"
reference = "fscm"
cases = { n = [1, 2], tags = ["blue"] }
metric = "rel"
lower = -0.1
upper = 0.1
max_reference_uncertainty = 1e-6
basis = "derived"
grounds = "A limit."
min_cases = 3
tier = "quick"
"""


def test_a_gate_is_read():
    (gate,) = load_gates(GATE)
    assert (gate.id, gate.lower, gate.upper, gate.min_cases) == ("A-GATE", -0.1, 0.1, 3)
    assert (gate.reference_at, gate.rival, gate.not_applicable, gate.expected_failure) == (
        {},
        None,
        "error",
        None,
    )


def test_ranges_include_their_ends_and_tags_name_grids_or_properties():
    (gate,) = load_gates(GATE)
    blue, red = (Grid(id, "", "quick", "fscm", (), (), (), (tag,)) for id, tag in (("a", "blue"), ("b", "red")))
    by_id = Grid("blue", "", "quick", "fscm", (), (), ())
    assert [gate.selects(blue, Problem.dimensionless(n, 0, 1)) for n in (0.99, 1, 1.5, 2, 2.01)] == [
        False,
        True,
        True,
        True,
        False,
    ]
    assert [gate.selects(grid, Problem.dimensionless(1, 0, 1)) for grid in (red, by_id)] == [False, True]


def test_a_range_of_poissons_ratio_does_not_select_a_case_without_one():
    (gate,) = load_gates(GATE.replace('n = [1, 2], tags = ["blue"]', "nu = [0, 0.49]"))
    grid = Grid("a", "", "quick", "fscm", (), (), ())
    assert [gate.selects(grid, Problem.dimensionless(2, 0, 1, nu)) for nu in (None, 0.0, 0.3)] == [False, True, True]


def test_the_reference_may_be_taken_at_other_parameters():
    (gate,) = load_gates(GATE + "reference_at = { k = 1, nu = 0.25 }")
    assert gate.reference_case(Problem.dimensionless(2, 0.95, 0.5)) == Problem.dimensionless(2, 1, 0.5, 0.25)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("min_cases = 3", "min_cases = 3\nminimum = 3", "unknown key 'minimum'; known are id, "),
        ("min_cases = 3", "", "min_cases missing; a gate has id, "),
        ("min_cases = 3", "min_cases = 0", "a gate without cases shows nothing"),
        ("min_cases = 3", 'min_cases = "3"', "min_cases = '3' must be an integer"),
        ("min_cases = 3", "min_cases = true", "min_cases = true must be an integer"),
        ("A-GATE", "a gate", "capitals"),
        ('"jkr"', '"hertz"', "unknown candidate 'hertz'"),
        ('"fscm"', '"given"', "unknown reference 'given'"),
        (
            '"rel"',
            '"relative"',
            "metric = 'relative' must be one of rel, abs, range-relative, en, curve: did you",
        ),
        ('"rel"', '"curve"', "unknown quantity"),
        ("pull_off_force", "pull_off", "unknown quantity"),
        ("pull_off_force", "force_curve", "unknown quantity"),
        ('"derived"', '"guessed"', "basis = 'guessed' must be one of derived, published, measured"),
        ('"derived"', '"measured"', "states its worst_measured"),
        ("min_cases = 3", "min_cases = 3\nworst_measured = 0.1", "states its worst_measured"),
        ('"quick"', '"slow"', "tier = 'slow' must be one of quick, full"),
        ("lower = -0.1", "lower = 0.2", "admit nothing"),
        ("lower = -0.1\nupper = 0.1", "lower = -inf\nupper = inf", "one must be finite"),
        ("lower = -0.1", "lower = nan", "admit nothing"),
        ("1e-6", "0", "positive"),
        ('metric = "rel"', 'metric = "en"\nrival = "dmt"', "compares with no rival"),
        ("1e-6", "inf", "positive"),
        ("n = [1, 2]", "n = [2, 1]", "[low, high]"),
        ("n = [1, 2]", "n = 1", "[low, high]"),
        ("n = [1, 2]", "m = [1, 2]", "cases: unknown key 'm': did you mean mu?"),
        (
            "min_cases = 3",
            'min_cases = 3\nnot_applicable = "pass"',
            "'pass' must be one of error, leave-out",
        ),
        ("[[gate]]", "[[gates]]", "unknown key 'gates': did you mean gate?"),
        ("[[gate]]", "[gate]", "must be [[gate]] tables"),
        ("[[gate]]", "[[gate]", "is not TOML: "),
        ("[[gate]]", "x = " + "[" * 5000 + "]" * 5000 + "\n[[gate]]", "nested too deeply"),
        ('tags = ["blue"]', 'tags = [["blue"]]', "cases.tags must be a list of at least one name; it holds ['blue']"),
        ('tags = ["blue"]', "tags = []", "cases.tags = [] must be a list of at least one name"),
        ("n = [1, 2]", "n = [true, true]", "[low, high]"),
        ("lower = -0.1", "lower = -1" + "0" * 400, "must be a number, or -inf for no limit"),
        ("min_cases = 3", 'min_cases = 3\nreference_at = { k = "1" }', "must be a number"),
        ("min_cases = 3", "min_cases = 3\nreference_at = { k = nan }", "reference_at.k = nan must be a finite number"),
        ("min_cases = 3", "min_cases = 3\nreference_at = { n = -4 }", "reference_at: shape index n = -4.0 is outside"),
        (
            "min_cases = 3",
            "min_cases = 3\nreference_at = { k = 1.5 }",
            "reference_at: gradient exponent k = 1.5",
        ),
        ('metric = "rel"', 'metric = "en"', "the metric en needs max_candidate_uncertainty"),
        ('metric = "rel"', 'metric = "en"\nmax_candidate_uncertainty = 1', "must be below 1 with the metric en"),
        ("1e-6", "1e-6\nmax_candidate_uncertainty = 0", "max_candidate_uncertainty = 0 must be positive"),
        ("1e-6", "1e-6\nmax_candidate_uncertainty = nan", "max_candidate_uncertainty = nan must be positive"),
        ("1e-6", "1e-6\nmax_candidate_uncertainty = inf", "max_candidate_uncertainty = inf must be positive"),
        ('"jkr"', '"fscm"', "candidate and reference are both 'fscm'"),
        ('"jkr"', '"fscm"\nreference_at = {}', "candidate and reference are both 'fscm'"),
        ("min_cases = 3", 'min_cases = 3\nrival = "jkr"', "candidate and rival are both 'jkr'"),
        ("lower = -0.1", "lower = -1e300", "lower = -1e+300 is beyond 1000 in size"),
        ("upper = 0.1", "upper = 1e300", "upper = 1e+300 is beyond 1000 in size"),
        ("lower = -0.1\nupper = 0.1", "lower = -inf\nupper = 1000.5", "upper = 1000.5 is beyond 1000 in size"),
        ("lower = -0.1\nupper = 0.1", "lower = -1000.5\nupper = inf", "lower = -1000.5 is beyond 1000 in size"),
        ("upper = 0.1", "upper = 1e300 #", "state a smaller limit, or upper = inf for none"),
        ('"derived"', '"measured"\nworst_measured = nan', "worst_measured = nan must be a finite number"),
        ('"derived"', '"measured"\nworst_measured = inf', "worst_measured = inf must be a finite number"),
        (
            '"derived"',
            '"measured"\nworst_measured = 0.1001',
            "worst_measured = 0.1001 is not within the limits -0.1 to 0.1",
        ),
        (
            '"derived"',
            '"measured"\nexpected_failure = "Known."\nworst_measured = 0.1\nmeasured_range = [0.09, 0.11]',
            "worst_measured = 0.1 is within the limits -0.1 to 0.1",
        ),
        (
            '"derived"',
            '"measured"\nexpected_failure = "Known."\nworst_measured = 0.2',
            "expected_failure needs measured_range = [low, high]",
        ),
        ("min_cases = 3", "min_cases = 3\nmeasured_range = [0, 0.1]", "states its worst_measured"),
        (
            '"derived"',
            '"measured"\nworst_measured = 0.01\nmeasured_range = [0, 0.0099]',
            "measured_range = [0, 0.0099] must contain worst_measured, which is 0.01",
        ),
        (
            '"derived"',
            '"measured"\nworst_measured = 0.01\nmeasured_range = [0.02, 0.01]',
            "must contain worst_measured",
        ),
        (
            '"derived"',
            '"measured"\nworst_measured = 0.01\nmeasured_range = [nan, 0.02]',
            "must contain worst_measured",
        ),
        (
            '"derived"',
            '"measured"\nworst_measured = 0.01\nmeasured_range = [-0.1001, 0.02]',
            "reaches beyond 10 times worst_measured = 0.01",
        ),
        (
            '"derived"',
            '"measured"\nworst_measured = 0.01\nmeasured_range = [0, inf]',
            "reaches beyond 10 times worst_measured = 0.01",
        ),
        ("min_cases = 3", "min_cases = 3\nmeasured_range = 0.1", "[low, high]"),
        ("A limit.", "", "grounds = '' is empty"),
        ("A limit.", " \\n\\t ", "is empty"),
        ("JKR is right.", "  ", "requirement = '  ' is empty"),
        ("min_cases = 3", 'min_cases = 3\nexpected_failure = ""', "expected_failure = '' is empty"),
        ("A limit.", "A \\u001b[31mlimit.", "grounds holds the character '\\x1b'"),
        ("JKR is", "JKR\\u202e is", "requirement holds the character '\\u202e'"),
        ("JKR is", "JKR\\u0085 is", "requirement holds the character '\\x85'"),
        (
            "min_cases = 3",
            'min_cases = 3\nexpected_failure = "\\u0007"',
            "expected_failure holds the character '\\x07'",
        ),
        ("A-GATE", "A-GATE\\n", r"gate 1 (id = 'A-GATE\n')"),
        ("A-GATE", "A-\\u001b[31mGATE", r"gate 1 (id = 'A-\x1b[31mGATE')"),
        ("min_cases = 3", 'min_cases = 3\n"\\u001b[31m" = 1', r"unknown key '\x1b[31m'; known are id, "),
        ("[[gate]]", '"\\u001b[31m" = 1\n[[gate]]', r"unknown key '\x1b[31m'; known are gate, grounds"),
        ("A-GATE", "\u0391-GATE", "capitals"),
        ("min_cases = 3", "min_case = 3", "unknown key 'min_case': did you mean min_cases?"),
        ('"jkr"', '"jrk"', "unknown candidate 'jrk': did you mean jkr?"),
        ("pull_off_force", "pulloff_force", "unknown quantity of the metric rel 'pulloff_force': did you mean"),
        ('"A limit."', '"A limit."\nshared_grounds = "x"', "either grounds, one sentence, or shared_grounds"),
        ('grounds = "A limit."', "", "either grounds, one sentence, or shared_grounds"),
        ('grounds = "A limit."', 'shared_grounds = "none"', "unknown shared grounds 'none'"),
        ("[[gate]]", '[grounds]\nspare = "A limit."\n[[gate]]', "no gate has the shared grounds spare"),
        ("[[gate]]", "[grounds]\nspare = 1\n[[gate]]", "grounds.spare = 1 must be one sentence"),
        ("[[gate]]", '[grounds]\nspare = " "\n[[gate]]', "spare = ' ' is empty"),
    ],
)
def test_what_is_wrong_is_refused_and_named(old, new, sentence, tmp_path, capsys):
    text = GATE.replace(old, new)
    with pytest.raises(ValueError, match=re.escape(sentence)):
        load_gates(text)
    (tmp_path / "gates.toml").write_text(text)
    assert main(["run", "--gates", str(tmp_path / "gates.toml"), "--out", str(tmp_path / "out")]) == 2
    shown = capsys.readouterr()
    assert shown.err.count("\n") == 1
    assert sentence in shown.err
    assert shown.err.rstrip("\n").isprintable()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"jkr"', '"fscm"\nreference_at = { k = 0 }'),
        ("upper = 0.1", "upper = 1000"),
        ("lower = -0.1\nupper = 0.1", "lower = -1000\nupper = inf"),
        ('metric = "rel"\nlower = -0.1', 'metric = "abs"\nlower = -1e6'),
        ('"derived"', '"measured"\nworst_measured = -0.1'),
        (
            '"derived"',
            '"measured"\nexpected_failure = "Known."\nworst_measured = 0.1001\nmeasured_range = [0.1001, 1.001]',
        ),
        ('"derived"', '"derived"\nworst_measured = -0.01\nmeasured_range = [-0.1, 0.1]'),
        ('metric = "rel"', 'metric = "en"\nmax_candidate_uncertainty = 0.999'),
        ("1e-6", "1e-6\nmax_candidate_uncertainty = 7"),
    ],
)
def test_what_can_fail_is_read(old, new):
    assert GATE.replace(old, new) != GATE
    assert len(load_gates(GATE.replace(old, new))) == 1


@pytest.mark.parametrize("upper", ["0", "-0.1"])
def test_a_distance_that_must_be_negative_is_refused(upper):
    curve = GATE.replace('"rel"', '"curve"').replace("pull_off_force", "force_curve").replace("= -0.1", "= -inf")
    assert load_gates(curve)
    with pytest.raises(ValueError, match=f"upper = {upper} must be positive: no distance is smaller"):
        load_gates(curve.replace("upper = 0.1", f"upper = {upper}"))


def test_the_candidate_at_its_own_parameters_is_no_other_reference():
    same = GATE.replace('"jkr"', '"fscm"').replace("n = [1, 2]", "n = [2, 2], k = [0, 0]")
    with pytest.raises(ValueError, match="always 0"):
        load_gates(same + "reference_at = { n = 2, k = 0 }")
    assert load_gates(same + "reference_at = { n = 2, k = 0.4 }")


def test_line_ends_in_a_text_become_spaces():
    (gate,) = load_gates(GATE.replace('"A limit."', '"""\nA limit,\n  of Eq. 51\tfor k = 0.\n"""'))
    assert gate.grounds == "A limit, of Eq. 51 for k = 0."


@pytest.mark.parametrize("text", ["gate = [1]", "gate = [[]]", "gate = 1", "", "[[gate]"])
def test_a_file_of_another_shape_is_refused_by_its_name(text, tmp_path, capsys):
    (tmp_path / "mine.toml").write_text(text)
    assert main(["run", "--gates", str(tmp_path / "mine.toml"), "--out", str(tmp_path / "out")]) == 2
    shown = capsys.readouterr()
    assert shown.err.count("\n") == 1
    assert "mine.toml" in shown.err


def test_several_gates_share_their_grounds():
    text = '[grounds]\nlimit = "A limit\\nof Eq. 51."\n' + GATE + GATE.replace("A-GATE", "B-GATE")
    for gate in load_gates(text.replace('grounds = "A limit."', 'shared_grounds = "limit"')):
        assert gate.grounds == "A limit of Eq. 51."


def test_the_schema_names_the_metrics_and_tiers_of_the_code():
    schema = json.loads(files("comparisons.data").joinpath("gates.schema.json").read_text(encoding="utf-8"))
    entries = schema["properties"]["gate"]["items"]["properties"]
    assert entries["metric"]["enum"] == list(METRICS)
    assert entries["tier"]["enum"] == list(TIERS)
    assert entries.keys() - {"shared_grounds"} == {field.name for field in fields(Gate)}


def test_two_gates_of_one_id_are_refused():
    with pytest.raises(ValueError, match="A-GATE is there twice"):
        load_gates(GATE + GATE)


def test_a_file_that_is_not_there_is_refused(tmp_path, capsys):
    assert main(["run", "--gates", str(tmp_path / "no.toml")]) == 2
    assert "cannot be read" in capsys.readouterr().err


STANDING = load_gates(gates_text())


def test_there_are_enough_standing_gates():
    assert len(of_tier(STANDING, "quick")) >= 25


@pytest.mark.parametrize("gate", STANDING, ids=lambda gate: gate.id)
def test_a_standing_gate_is_fit_to_be_cited(gate):
    for text in (gate.requirement, gate.grounds, gate.expected_failure or "."):
        assert text.endswith(".")
    assert gate.candidate in {*MODELS, GIVEN}
    if gate.worst_measured is not None:
        assert (gate.lower <= gate.worst_measured <= gate.upper) is (gate.expected_failure is None)
    declared = {
        case
        for grid in grids(gate.tier)
        if gate.quantity in grid.quantities
        for case in grid.cases
        if gate.selects(grid, case)
    }
    assert len(declared) >= gate.min_cases
    assert math.isfinite(gate.upper)
