"""Template of `new-model`: installed, checked, tested, and gated by its workflow."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.cli.options import FAILED, FAILS, INCONCLUSIVE, OK, WRONG_INPUT
from comparisons.external.model_source import GROUP

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def package(tmp_path, capsys):
    folder = tmp_path / "my-model"
    assert main(["new-model", str(folder)]) == 0
    shown = capsys.readouterr()
    assert f"check-model {folder / 'my_model.py'}:MyModel" in shown.err
    assert sorted(shown.out.splitlines()) == sorted(str(path) for path in folder.rglob("*") if path.is_file())
    return folder


def test_nothing_is_left_to_fill_in(package):
    for path in package.rglob("*"):
        if path.is_file():
            assert not re.search(r"@[A-Z]+@", path.read_text()), path


def test_the_model_keeps_the_contract(package, capsys):
    assert main(["check-model", f"{package / 'my_model.py'}:MyModel"]) == 0
    assert "is right in the limit jkr" in capsys.readouterr().out


def test_the_entry_point_names_the_class(package):
    project = tomllib.loads((package / "pyproject.toml").read_text())
    module, _, cls = project["project"]["entry-points"][GROUP]["my-model"].partition(":")
    assert f"class {cls}:" in (package / f"{module}.py").read_text()
    assert project["tool"]["setuptools"]["py-modules"] == [module]


def test_its_own_tests_pass(package):
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(package)]
    program = f"import sys, pytest; sys.path[:0] = [{str(ROOT)!r}]; sys.exit(pytest.main({command[3:]!r}))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=package)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2 passed" in done.stdout


def test_its_gate_is_a_gate(package):
    (gate,) = tomllib.loads((package / "gates.toml").read_text())["gate"]
    assert gate["candidate"] == "my-model"
    # 1.5 against the FSCM at n = 2, k = 0, mu = 2, the worst of the cases.
    assert gate["worst_measured"] == pytest.approx(1.5 / 1.58359530 - 1, abs=1e-4)


def test_the_workflow_knows_the_exit_statuses(package):
    text = (package / ".github" / "workflows" / "judge.yml").read_text()
    assert "fscm-bench check-model my-model" in text
    assert "fscm-bench run --model my-model --gates gates.toml $fresh --out results" in text
    assert f'"$status" -eq {INCONCLUSIVE}' in text
    # It has a message of its own and fails the job all the same.
    assert "exit 0" not in text
    meanings = {
        OK: "pass",
        FAILS: "fails",
        WRONG_INPUT: "wrong input",
        INCONCLUSIVE: "inconclusive",
        FAILED: "failed",
    }
    line = next(line for line in text.splitlines() if "# 0 all gates pass" in line)
    for status, meaning in meanings.items():
        assert re.search(rf"{status} [^,]*{meaning}", line), meaning
    assert "if: always()" in text


@pytest.mark.parametrize("status", [OK, FAILS, WRONG_INPUT, INCONCLUSIVE, FAILED])
def test_the_workflow_ends_with_the_status_of_the_run(package, tmp_path, status):
    lines = (package / ".github" / "workflows" / "judge.yml").read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.strip() == "status=0")
    end = next(i for i in range(start, len(lines)) if lines[i].strip() == 'exit "$status"')
    program = tmp_path / "bin" / "fscm-bench"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\necho "$@"\nexit {status}\n')
    program.chmod(0o755)
    script = "\n".join(line.strip() for line in lines[start : end + 1])
    done = subprocess.run(
        ["sh", "-e", "-c", script],
        env={"PATH": f"{program.parent}:/usr/bin:/bin", "GITHUB_RUN_ID": str(2**32 + 17)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == status
    assert "--random 20 --seed 17" in done.stdout
    assert ("::error::inconclusive" in done.stdout) == (status == INCONCLUSIVE)


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("<b>", "letters, digits"),
        ("3d", "begins with a digit"),
        ("given", "gates"),
        ("fscm", "a model of fscm-bench"),
        ("jkr", "a model of fscm-bench"),
        ("md-improved", "a model of fscm-bench"),
        ("MD.improved", "a model of fscm-bench"),
        ("comparisons", "hides another"),
        ("fem-reference", "hides another"),
        ("Json", "hides another"),
        ("numpy", "hides another"),
        ("lambda", "Python language"),
        ("true", "Python language"),
        ("not-applicable", "what the template imports"),
        ("my-model-", "ends in a sign"),
    ],
)
def test_a_name_that_cannot_be_is_refused(tmp_path, capsys, name, sentence):
    assert main(["new-model", str(tmp_path / name)]) == 2
    shown = capsys.readouterr().err
    assert sentence in shown
    assert shown.count("\n") == 1
    assert not (tmp_path / name).exists()


def test_nothing_is_overwritten(package, capsys):
    before = (package / "my_model.py").read_text()
    assert main(["new-model", str(package)]) == 2
    assert "not an empty folder" in capsys.readouterr().err
    assert (package / "my_model.py").read_text() == before
