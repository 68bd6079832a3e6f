"""Start of the program: other distributions with packages of the same names, and extras that are not installed."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from comparisons.console.exit_status import WRONG_INPUT, guarded
from comparisons.console.installation import EXTRAS, check_packages, sentence_on_missing_module

ROOT = Path(__file__).resolve().parents[3]
PACKAGES = ("fscm", "fem_reference", "comparisons")
#: Puts the folder of the packages, which the tests do not install, before all others, and starts the program.
START = "import sys; sys.path[:0] = {folders!r}; from fscm_bench import main; sys.exit(main())"


def folder_with(root, *distributions):
    """A folder as pip makes it: links to the packages, and metadata of distributions."""
    root.mkdir()
    for package in PACKAGES:
        (root / package).symlink_to(ROOT / package, target_is_directory=True)
    for name in distributions:
        (root / name).mkdir()
    return root


@pytest.mark.parametrize("name", ["fscm-0.0.6.dist-info", "comparisons-0.4.dist-info", "Comparisons-1-py3.egg-info"])
def test_another_distribution_in_the_same_folder_is_one_sentence(tmp_path, monkeypatch, name):
    root = folder_with(tmp_path / "site-packages", "fscm_bench-0.1.0.dist-info", "fscmx-1.dist-info")
    monkeypatch.setattr("comparisons.console.installation._PACKAGES", ())
    check_packages(root)
    (root / name).mkdir()
    with pytest.raises(ValueError, match=r"another project is installed in .* too.*: pip uninstall") as caught:
        check_packages(root)
    other, version = name.removesuffix(".dist-info").removesuffix(".egg-info").split("-", 1)
    assert f"the distribution {other} {version.removesuffix('-py3')} " in str(caught.value)


def test_a_package_of_another_folder_is_one_sentence(tmp_path):
    with pytest.raises(ValueError, match=rf"Python finds .*fscm.__init__\.py as the package fscm, and not {tmp_path}"):
        check_packages(tmp_path)


def started(folders, *arguments):
    code = START.format(folders=[str(folder) for folder in folders])
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    # Not in the clone, whose packages would be found.
    return subprocess.run(
        [sys.executable, "-c", code, *arguments], cwd=folders[0], env=clean, capture_output=True, text=True
    )


@pytest.mark.parametrize("package", ["fscm", "comparisons"])
def test_a_package_of_the_same_name_is_found_first(tmp_path, package):
    other = tmp_path / "other" / package
    other.mkdir(parents=True)
    (other / "__init__.py").write_text("", encoding="utf-8")
    done = started([other.parent, ROOT, ROOT / "comparisons" / "start_entry"], "--help")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (WRONG_INPUT, "", 1)
    assert done.stderr.startswith("fscm-bench: Python finds ")
    assert str(other) in done.stderr


def test_the_program_starts_by_its_own_package(tmp_path):
    done = started([tmp_path, ROOT, ROOT / "comparisons" / "start_entry"], "--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("usage: fscm-bench")


#: Two closed forms beside a third, in two cases.
FORMS = 'id = "a", title = "A", reference = "bradley", models = ["jkr", "dmt"], quantities = ["pull_off_force"]'
GRID = f"grid = [{{ {FORMS}, n = [2], k = [0, 0.4], mu = [1] }}]"


@pytest.mark.parametrize("package", ["comparisons", "fscm_bench"])
def test_no_module_of_the_working_folder_is_imported_by_any_process_of_the_program(tmp_path, package):
    """Of the standard library, of a dependency, and of this program; started by ``python -m``, with two workers."""
    for name in ("typing", "random", "signal", "socket", "pickle", "pandas", "mpmath", "fem_reference"):
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'imported')!r}, 'a').write({name!r})\n1 / 0")
    (tmp_path / "grid.toml").write_text(GRID)
    search = os.pathsep.join([str(ROOT), str(ROOT / "comparisons" / "start_entry")])
    done = subprocess.run(
        [sys.executable, "-m", package, "sweep", "grid.toml", "--jobs", "2", "--out", "out"],
        cwd=tmp_path, env=os.environ | {"PYTHONPATH": search}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert not (tmp_path / "imported").exists()


def test_a_missing_package_of_an_extra_is_one_sentence(capsys):
    def command():
        raise ModuleNotFoundError("No module named 'bokeh.core'", name="bokeh.core")

    assert guarded(command) == WRONG_INPUT
    assert capsys.readouterr().err == (
        "fscm-bench: the package bokeh is not installed, which this command needs: pip install 'fscm-bench[report]'\n"
    )


def test_another_missing_package_is_a_defect():
    assert sentence_on_missing_module(ModuleNotFoundError("No module named 'numpy'", name="numpy")) is None
    assert sentence_on_missing_module(ModuleNotFoundError()) is None


#: Refuses the packages of the extra `report`, then calls the command.
WITHOUT_EXTRA = f"""
import sys
sys.meta_path.insert(0, type("Refusal", (), {{"find_spec": staticmethod(
    lambda name, *_: (_ for _ in ()).throw(ModuleNotFoundError(name=name)) if name in {set(EXTRAS)!r} else None)}}))
from comparisons.__main__ import main
sys.exit(main())
"""


@pytest.mark.parametrize(
    "arguments",
    [
        ["report", "--help"],
        ["leaderboard", "--help"],
        ["solve", "--model", "jkr", "--quantity", "pull_off_force", "--n", "2", "--k", "0", "--mu", "1"],
    ],
)
def test_only_plots_of_a_report_need_the_extra(arguments):
    done = subprocess.run([sys.executable, "-c", WITHOUT_EXTRA, *arguments], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
