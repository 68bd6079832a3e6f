"""Gates: files that are read, files that are refused, and the standing gates."""

import re

import pytest

from comparisons import Problem
from comparisons.judging.fresh_cases import RANDOM
from comparisons.judging.gates import load_gates
from comparisons.runs.cases import Grid
from tests.comparisons.conftest import GATES, with_entries

GATE = with_entries(
    GATES,
    id="A-GATE",
    candidate="jkr",
    reference="fscm",
    cases='{ n = [1, 2], tags = ["blue"] }',
    lower=-0.1,
    upper=0.1,
    grounds="A limit.",
    min_cases=3,
)
CURVE = GATE.replace('"rel"', '"curve"').replace("pull_off_force", "force_curve").replace("= -0.1", "= -inf")


def with_cases(text):
    return GATE.replace('n = [1, 2], tags = ["blue"]', text)


def test_ranges_include_their_ends_and_tags_name_grids_or_properties():
    (gate,) = load_gates(GATE)
    blue, red = (Grid(id, "", "quick", "fscm", (), (), (), (tag,)) for id, tag in (("a", "blue"), ("b", "red")))
    by_id = Grid("blue", "", "quick", "fscm", (), (), ())
    problems = [Problem.dimensionless(n, 0, 1) for n in (0.99, 1, 1.5, 2, 2.01)]
    assert [gate.selects(blue, problem) for problem in problems] == [False, True, True, True, False]
    assert [gate.selects(grid, problems[1]) for grid in (red, by_id)] == [False, True]


def test_a_range_does_not_select_a_case_without_a_value():
    grid = Grid("a", "", "quick", "fscm", (), (), ())
    (gate,) = load_gates(with_cases("nu = [0, 0.49]"))
    assert [gate.selects(grid, Problem.dimensionless(2, 0, 1, nu)) for nu in (None, 0.0, 0.3)] == [False, True, True]
    (gate,) = load_gates(with_cases('"solid.thickness" = ["1 nm", "2 nm"]'))
    assert not gate.selects(grid, Problem.dimensionless(2, 0, 1))


MEASURED = '"measured"\nworst_measured = '
KNOWN = '0.1\nexpected_failure = "Known."\nmeasured_range = '


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("min_cases = 3", "min_case = 3", "unknown key 'min_case': did you mean min_cases?"),
        ("min_cases = 3", "", "min_cases missing"),
        ("min_cases = 3", "min_cases = 0", "min_cases = "),
        ("A-GATE", "\u0391-GATE", "capitals"),
        ("A-GATE", f"A-GATE{RANDOM}", "ids of fresh cases"),
        ('"jkr"', '"jrk"', "unknown candidate 'jrk': did you mean jkr?"),
        ('"fscm"', '"given"', "unknown reference 'given'"),
        ('"rel"', '"curve"', "unknown quantity"),
        ("pull_off_force", "force_curve", "unknown quantity"),
        ("lower = -0.1", "lower = 0.2", "admit nothing"),
        (GATE, CURVE.replace("upper = 0.1", "upper = 0"), "to 0 must be"),
        ("lower = -0.1\nupper = 0.1", "lower = -inf\nupper = inf", "one must be finite"),
        ("lower = -0.1", "lower = nan", "lower = nan"),
        *(("1e-6", value, "max_reference_uncertainty") for value in ("0", "inf", "nan")),
        *(("1e-6", f"1e-6\nmax_candidate_uncertainty = {u}", "max_candidate_uncertainty") for u in ("0", "nan", "inf")),
        ('metric = "rel"', 'metric = "en"', "the metric en needs max_candidate_uncertainty"),
        ('metric = "rel"', 'metric = "en"\nmax_candidate_uncertainty = 1', "max_reference_uncertainty below 1"),
        *(("min_cases = 3", f"min_cases = 3\nmin_coverage = {share}", "min_coverage") for share in ("0", "1.1", "nan")),
        ('metric = "rel"', 'metric = "en"\nmax_candidate_uncertainty = 0.1\nrival = "dmt"', "compares with no rival"),
        ('"jkr"', '"fscm"', "the candidate 'fscm' is compared with itself"),
        ("min_cases = 3", 'min_cases = 3\nrival = "jkr"', "the candidate 'jkr' is compared with itself"),
        ("n = [1, 2]", "n = [2, 1]", "cases.n = [2, 1] must be [low, high]"),
        ("n = [1, 2]", "m = [1, 2]", "'m': did you mean mu?"),
        ("n = [1, 2]", '"solid.kind" = "coat"', "'coat': did you mean coating?"),
        ("n = [1, 2]", '"solid.kind" = [1, 2]', "solid.kind"),
        ("n = [1, 2]", '"solid.thickness" = ["1 GPa", "2 GPa"]', "cases.solid.thickness"),
        ("n = [1, 2]", '"solid.thickness" = ["2 nm", "1 nm"]', "low <= high"),
        ('tags = ["blue"]', "tags = []", "cases.tags = []"),
        *(("= 3", f"= 3\nreference_at = {{ k = {k} }}", "reference_at") for k in ('"1"', "nan", "1.5", "inf")),
        ('"derived"', '"measured"', "states its worst_measured"),
        ("min_cases = 3", "min_cases = 3\nworst_measured = 0.1", "states its worst_measured"),
        *(('"derived"', MEASURED + worst, f"worst_measured = {worst}") for worst in ("nan", "0.1001", "-0.1001")),
        ('"derived"', MEASURED + KNOWN + "[0.09, 0.11]", "worst_measured = 0.1"),
        ('"derived"', MEASURED + '0.2\nexpected_failure = "Known."', "expected_failure needs measured_range"),
        *(
            ('"derived"', f"{MEASURED}0.01\nmeasured_range = [{ends}]", "measured_range")
            for ends in ("0, 0.0099", "nan, 0.02", "-0.1001, 0.02", "0, inf", "0.02, 0.01")
        ),
        *(("A limit.", text, "grounds") for text in ("", " \\n\\t ", "A \\u001b[31mlimit.", "A\\u202e limit.")),
        ('"A limit."', '"A limit."\nshared_grounds = "x"', "either grounds, one sentence, or shared_grounds"),
        ('grounds = "A limit."', 'shared_grounds = "none"', "unknown shared grounds 'none'"),
        ("[[gate]]", '[grounds]\nspare = "A limit."\n[[gate]]', "no gate has the shared grounds spare"),
        ("[[gate]]", "[gate]", "must be [[gate]] tables"),
        ("[[gate]]", "x = " + "[" * 5000 + "]" * 5000 + "\n[[gate]]", "nested too deeply"),
        (GATE, GATE + GATE, "A-GATE is there twice"),
        *((GATE, text, "gate") for text in ("gate = [1]", "gate = [[]]", "gate = 1", "")),
    ],
)
def test_what_is_wrong_is_refused_and_named(old, new, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)) as refusal:
        load_gates(GATE.replace(old, new))
    assert str(refusal.value).isprintable()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"jkr"', '"fscm"\nreference_at = { k = 0 }'),
        (GATE, CURVE),
        ("lower = -0.1\nupper = 0.1", "lower = -1000\nupper = inf"),
        ('"derived"', MEASURED + "-0.1"),
        ('"derived"', MEASURED + KNOWN.replace("0.1", "0.1001") + "[0.1001, 1.001]"),
        ('"derived"', '"derived"\nworst_measured = -0.01\nmeasured_range = [-0.1, 0.1]'),
        ('metric = "rel"', 'metric = "en"\nmax_candidate_uncertainty = 0.999'),
        ("1e-6", "1e-6\nmax_candidate_uncertainty = 7"),
        ("n = [1, 2]", "n = [1, inf]"),
        (GATE, '[grounds]\na = "A limit."\n' + GATE.replace('grounds = "A limit."', 'shared_grounds = "a"')),
    ],
)
def test_what_can_fail_is_read(old, new):
    assert GATE.replace(old, new) != GATE
    assert len(load_gates(GATE.replace(old, new))) == 1


def test_the_candidate_at_its_own_parameters_is_no_other_reference():
    same = GATE.replace('"jkr"', '"fscm"').replace("n = [1, 2]", "n = [2, 2], k = [0, 0]")
    with pytest.raises(ValueError, match="compared with itself"):
        load_gates(same + "reference_at = { n = 2, k = 0 }")
    assert load_gates(same + "reference_at = { n = 2, k = 0.4 }")
