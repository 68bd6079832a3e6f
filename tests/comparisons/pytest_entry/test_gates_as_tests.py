"""The plugin of pytest: gates as tests, and nothing at all without its options."""

import pytest

from comparisons.pipeline.run import named_verdicts
from tests.paths import ROOT

from ..conftest import GATES, with_entries
from ..grid_text import PAD, grid_text

pytest_plugins = ["pytester"]

PLUGIN = "fscm_bench_pytest"


@pytest.fixture
def small_grid(small_grid, tmp_path):
    """The four cases of toy models, after one run: pytester drops every module that a run inside it imports first."""
    verdicts = named_verdicts("quick", GATES, ["ten-percent"], tmp_path / "before")
    assert {verdict for _, verdict, _ in verdicts} == {"PASS"}


@pytest.fixture(autouse=True)
def importable(monkeypatch):
    """Also where the package is installed without its plugin, as before the plugin was written."""
    monkeypatch.syspath_prepend(str(ROOT / "comparisons" / "pytest_entry"))
    monkeypatch.setenv("PYTHONPATH", str(ROOT / "comparisons" / "pytest_entry"))


def gate(id, candidate, lower, upper, **entries):
    return with_entries(GATES, id=id, candidate=candidate, lower=lower, upper=upper, **entries)


DECLARED = {"expected_failure": "it is twelve percent", "worst_measured": 0.12, "measured_range": "[0.11, 0.13]"}

EVERY = "".join(
    [
        gate("PASSES", "given", 0.05, 0.15, not_applicable="leave-out"),
        gate("FAILS", "ten-percent", -0.05, 0.05),
        gate("DECLARED", "twelve-percent", 0.0, 0.1, **DECLARED),
        gate("UNCERTAIN", "ten-percent", 0.05, 0.1),
    ]
)


def run(pytester, text, *options, models=("ten-percent",)):
    pytester.makefile(".toml", gates=text)
    named = [f"--fscm-bench-model={model}" for model in models]
    return pytester.runpytest_inprocess("-p", PLUGIN, "--fscm-bench-gates=gates.toml", *named, *options)


def test_each_gate_and_case_is_a_test(small_grid, pytester):
    result = run(pytester, EVERY, "-rA", models=("ten-percent", "twelve-percent", "refuses"))
    # PASSES: two models pass and one is skipped; the others have one model each; a whole-gate verdict on "refuses".
    result.assert_outcomes(passed=8, skipped=4, failed=8 + 1, xfailed=4)
    result.stdout.fnmatch_lines(
        [
            "ERROR: 0 cases were evaluated, fewer than min_cases = 4*",
            "*FAILS?ten-percent n=2 k=0 mu=0.1?*",
            "FAIL: E = 0.1*, U = *, limits -0.05 to 0.05",
            "computed again by: fscm-bench solve --model ten-percent --quantity pull_off_force --n 2 --k 0 --mu 0.1",
            "INCONCLUSIVE: *reaches across the limit 0.1*",
        ]
    )
    output = result.stdout.str()
    assert "it has no such [thing]" in output
    assert "it is twelve percent" in output
    assert "Traceback" not in output
    assert "named_verdicts.py" not in output


def test_an_ini_file_names_them_and_one_gate_can_be_chosen(small_grid, pytester):
    pytester.makefile(".toml", gates=EVERY)
    pytester.makeini("[pytest]\nfscm_bench_gates = gates.toml\nfscm_bench_model =\n    ten-percent\n")
    pytester.makepyfile(test_mine="def test_of_mine():\n    pass")
    chosen = pytester.runpytest_inprocess("-p", PLUGIN, "-k", "PASSES or mine", "--fscm-bench-out=kept")
    chosen.assert_outcomes(passed=5, deselected=8)
    assert (pytester.path / "kept" / "junit.xml").is_file()
    # Tests that are named come alone.
    pytester.runpytest_inprocess("-p", PLUGIN, "test_mine.py").assert_outcomes(passed=1)


def test_problem_files_take_the_place_of_the_standing_cases(small_grid, pytester):
    entries = {"reference": "bradley", "cases": '{ "punch.R" = ["1 um", "2 um"] }', "min_cases": 2}
    cases = grid_text(["jkr"], problem="pad.toml", vary={"punch.R": ["1 um", "2 um"]})
    pytester.makefile(".toml", cases=cases, pad=PAD)
    pytester.makeini("[pytest]\nfscm_bench_cases = cases.toml\n")
    result = run(pytester, gate("PADS", "jkr", -0.26, -0.24, **entries), "-rA", models=["jkr"])
    result.assert_outcomes(passed=2)
    result.stdout.fnmatch_lines(["*PADS?jkr pad.toml; punch.R=1 um?*"])


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ("--fscm-bench-model=jkr", "--fscm-bench-gates FILE is missing"),
        ("--fscm-bench-gates=gates.toml", "--fscm-bench-model SPEC is missing"),
        ("--fscm-bench-gates=none.toml --fscm-bench-model=jkr", "none.toml does not exist"),
    ],
)
def test_what_is_missing_is_named(pytester, options, sentence):
    result = pytester.runpytest_inprocess("-p", PLUGIN, *options.split())
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines([f"ERROR: *{sentence}*"])


def test_what_cannot_be_judged_is_one_sentence(small_grid, pytester):
    pytester.mkdir("kept")
    (pytester.path / "kept" / "store.sqlite").write_text(500 * "no store\n")
    for text, option, sentence in (
        (EVERY.replace("0.15", "-0.15"), "-q", "*admit nothing or everything*"),
        (gate("PASSES", "given", 0.05, 0.15), "--fscm-bench-out=kept", "*kept/store.sqlite is not a store*"),
        (gate("OTHERS", "twelve-percent", 0.0, 0.2), "-q", "*no gate*"),
    ):
        result = run(pytester, text, option)
        result.assert_outcomes(errors=1)
        result.stdout.fnmatch_lines([sentence])
        result.stdout.no_fnmatch_line("*gate_checks*")


def test_it_costs_nothing_in_other_projects(pytester):
    """Not even in one with a package of the same name: the plugin is loaded, and nothing of fscm-bench is."""
    pytester.mkpydir("comparisons")
    pytester.makepyfile(
        """
        import sys

        def test_nothing_is_imported():
            assert "fscm_bench_pytest" in sys.modules
            heavy = {"fscm", "fem_reference", "comparisons", "numpy", "pandas", "scipy", "threadpoolctl", "filelock"}
            assert not heavy & sys.modules.keys()

        def test_the_package_of_the_project_is_its_own():
            import comparisons
            assert not hasattr(comparisons, "create")
        """
    )
    pytester.runpytest_subprocess("-p", PLUGIN).assert_outcomes(passed=2)
