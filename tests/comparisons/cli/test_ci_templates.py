"""The action of GitHub and the template of GitLab: they parse, are pinned, and their commands run here."""

import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
import yaml

from comparisons.cli.main import main
from comparisons.console.exit_status import FAILED, FAILS, INCONCLUSIVE, OK, WRONG_INPUT

ROOT = Path(__file__).resolve().parents[3]
ACTION = ROOT / ".github" / "actions" / "fscm-bench" / "action.yml"
GITLAB = ROOT / "docs" / "ci" / "gitlab.yml"

MODEL = """
from comparisons import NotApplicable, Result


class Mine:
    name, version, citation, domain = "mine", "1", "none", "n = 2"

    def evaluate(self, problem, quantity):
        if quantity != "pull_off_force" or problem.n != 2:
            raise NotApplicable("it is for the pull-off force at n = 2")
        return Result((3 + problem.k) / 2, u_num=1e-15)
"""

GATES = """
[[gate]]
id = "STIFF"
requirement = "The pull-off force at mu = 3 and 5 is within 5 %."
quantity = "pull_off_force"
candidate = "mine"
reference = "fscm"
cases = { n = [2, 2], k = [0.4, 0.4], mu = [3, 5] }
metric = "rel"
lower = -0.05
upper = 0.05
max_reference_uncertainty = 1e-4
basis = "derived"
grounds = "a test"
min_cases = 2
tier = "quick"
"""


@pytest.fixture(scope="module")
def action():
    return yaml.safe_load(ACTION.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def job():
    return yaml.safe_load(GITLAB.read_text(encoding="utf-8"))[".fscm-bench"]


def refused(schema, *paths, more=()):
    """What `check-jsonschema`, which has the published schemas of both systems, says against these files."""
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{schema}", *more]
    done = subprocess.run([*command, *map(str, paths)], capture_output=True, text=True)
    return "" if done.returncode == 0 else done.stdout + done.stderr


@pytest.mark.lint
def test_the_files_and_the_examples_of_the_page_fit_the_published_schemas(tmp_path, examples):
    assert main(["new-model", str(tmp_path / "my-model")]) == 0
    workflows = [*(ROOT / ".github" / "workflows").glob("*.yml"), *tmp_path.rglob("*.yml")]
    assert len(workflows) == 4
    assert refused("github-workflows", *workflows) == ""
    assert refused("github-actions", ACTION) == ""
    for_gitlab = ["--data-transform", "gitlab-ci"]
    assert refused("gitlab-ci", GITLAB, more=for_gitlab) == ""
    for schema, text, more in zip(("github-workflows", "gitlab-ci"), examples, ((), for_gitlab), strict=True):
        (tmp_path / f"{schema}.yml").write_text(text)
        assert refused(schema, tmp_path / f"{schema}.yml", more=more) == ""


@pytest.fixture(scope="module")
def examples():
    """The workflow of GitHub and the job of GitLab that the page shows."""
    blocks = re.findall(r"^```yaml\n(.*?)^```$", (ROOT / "docs" / "ci.md").read_text(encoding="utf-8"), re.M | re.S)
    of_github, of_gitlab = [block for block in blocks if "jobs:" in block], [b for b in blocks if "extends:" in b]
    assert len(of_github) == len(of_gitlab) == 1
    return of_github[0], of_gitlab[0]


def test_the_examples_of_the_page_use_what_there_is(examples, action, job):
    """The next test has the whole of their keys."""
    of_github, of_gitlab = map(yaml.safe_load, examples)
    *_, judge = of_github["jobs"]["judge"]["steps"]
    required = {name for name, value in action["inputs"].items() if value.get("required")}
    assert required <= judge["with"].keys() <= action["inputs"].keys()
    assert of_gitlab["judge"]["extends"] == ".fscm-bench"
    assert of_gitlab["judge"]["variables"].keys() <= job["variables"].keys()


def step(action, name):
    (match,) = [ci_step for ci_step in action["runs"]["steps"] if ci_step["name"] == name]
    return match


def environment(ci_step, inputs, tmp_path):
    """The environment of a step: the expressions of GitHub with these inputs."""
    values = {f"inputs.{name}": value for name, value in inputs.items()} | {"github.action_path": str(ACTION.parent)}
    filled = {
        name: re.sub(r"\$\{\{ ([\w.-]+) \}\}", lambda match: values[match[1]], text)
        for name, text in ci_step.get("env", {}).items()
    }
    return filled | {"GITHUB_OUTPUT": str(tmp_path / "output.txt")}


def shell(script, folder, variables, path=None):
    """Run a script as a CI system does: it ends at the first command that fails."""
    programs = f"{path}:/usr/bin:/bin" if path else f"{Path(sys.executable).parent}:/usr/bin:/bin"
    base = {"PATH": programs, "HOME": str(folder), "OPENBLAS_NUM_THREADS": "1"}
    # Seeds are below 2^32; identifiers of runs are not.
    base |= {"GITHUB_RUN_ID": str(2**32 + 17), "CI_PIPELINE_ID": str(2**32 + 18)}
    base |= {name: value for name, value in os.environ.items() if name.startswith("COVERAGE")}
    return subprocess.run(
        ["bash", "--noprofile", "--norc", "-e", "-o", "pipefail", "-c", script],
        env=base | variables,
        cwd=folder,
        capture_output=True,
        text=True,
    )


def defaults(action, **inputs):
    inputs_by_default = {name: str(value.get("default", "")) for name, value in action["inputs"].items()}
    return inputs_by_default | {name.replace("_", "-"): value for name, value in inputs.items()}


def test_the_action_is_whole(action):
    assert action["runs"]["using"] == "composite"
    assert {name for name, value in action["inputs"].items() if value.get("required")} == {"model"}
    for ci_step in action["runs"]["steps"]:
        assert ("run" in ci_step) != ("uses" in ci_step)
        # A composite action has no default shell.
        assert ci_step.get("shell") == ("bash" if "run" in ci_step else None)
        # An input is no part of a script: it comes as a variable, which no shell takes for a command.
        assert "${{" not in ci_step.get("run", "")
    named = set(re.findall(r"inputs\.([\w-]+)", ACTION.read_text(encoding="utf-8")))
    assert named == action["inputs"].keys()


def test_every_version_is_pinned(action, job, tmp_path):
    assert main(["new-model", str(tmp_path / "my-model")]) == 0
    (written,) = tmp_path.rglob("*.yml")
    author = yaml.safe_load(written.read_text())["jobs"]["judge"]
    used = [ci_step["uses"] for ci_step in [*action["runs"]["steps"], *author["steps"]] if "uses" in ci_step]
    assert len(used) == 7
    assert "latest" not in author["runs-on"]
    assert [name for name in used if not re.fullmatch(r"actions/[a-z-]+@[0-9a-f]{40}", name)] == []
    assert re.fullmatch(r"python:3\.\d+\.\d+-slim-\w+", job["image"])


def wheel(folder, version="9.9"):
    """An empty wheel of this name."""
    info = f"fscm_bench-{version}.dist-info"
    with zipfile.ZipFile(folder / f"fscm_bench-{version}-py3-none-any.whl", "w") as archive:
        archive.writestr("installed_offline.py", "")
        archive.writestr(f"{info}/METADATA", f"Metadata-Version: 2.1\nName: fscm-bench\nVersion: {version}\n")
        archive.writestr(
            f"{info}/WHEEL", "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
        )
        archive.writestr(f"{info}/RECORD", "")


@pytest.mark.parametrize("system", ["github", pytest.param("gitlab", marks=pytest.mark.heavy)])
def test_it_installs_from_wheels_without_a_network(action, job, tmp_path, system):
    wheel(tmp_path)
    offline = {
        "PIP_TARGET": str(tmp_path / "target"),
        "PIP_NO_CACHE_DIR": "1",
        "no_proxy": "",
        "https_proxy": "http://0.0.0.0:9",
    }
    if system == "github":
        install = step(action, "Install fscm-bench")
        variables = environment(install, defaults(action, wheels=str(tmp_path)), tmp_path)
        done = shell(install["run"], tmp_path, variables | offline)
    else:
        variables = job["variables"] | {"FSCM_BENCH_WHEELS": str(tmp_path)}
        done = shell("\n".join(job["before_script"]), tmp_path, variables | offline)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "target" / "installed_offline.py").exists()


def test_without_wheels_the_action_installs_its_own_repository(action, tmp_path):
    program = stub(tmp_path, "python", 'echo "$@"')
    install = step(action, "Install fscm-bench")
    for inputs, expected in (
        ({}, f"-m pip install {ACTION.parent}/../../.."),
        ({"package": "a.whl"}, "-m pip install a.whl"),
    ):
        done = shell(
            install["run"], tmp_path, environment(install, defaults(action, **inputs), tmp_path), program.parent
        )
        assert done.stdout.splitlines() == [expected, "-m pip install fscm-bench[report]"]
    assert (ACTION.parent / "../../.." / "pyproject.toml").exists()


def test_nothing_is_installed_by_its_bare_name(job, tmp_path):
    """Anybody may register the name in a package index: without an address the job fails before pip runs."""
    program = stub(tmp_path, "python", 'echo "$@"')
    script = "\n".join(job["before_script"])
    done = shell(script, tmp_path, job["variables"], program.parent)
    assert done.returncode != 0
    assert done.stdout == ""
    assert "git+https://" in done.stderr
    done = shell(script, tmp_path, job["variables"] | {"FSCM_BENCH_PACKAGE": "git+https://a/b/c@v1"}, program.parent)
    assert done.stdout.splitlines()[0] == "-m pip install git+https://a/b/c@v1"
    assert main(["new-model", str(tmp_path / "my-model")]) == 0
    workflow = yaml.safe_load((tmp_path / "my-model" / ".github" / "workflows" / "judge.yml").read_text())
    (install,) = [
        ci_step["run"] for ci_step in workflow["jobs"]["judge"]["steps"] if "pip install" in ci_step.get("run", "")
    ]
    program = stub(tmp_path, "pip", 'echo "$@"')
    done = shell(install, tmp_path, workflow["env"], program.parent)
    assert (done.returncode != 0, done.stdout) == (True, "")
    done = shell(install, tmp_path, {"FSCM_BENCH": "a.whl"}, program.parent)
    assert done.stdout.splitlines() == ["install a.whl", "install fscm-bench[report] .[test]"]


def stub(tmp_path, name, script):
    program = tmp_path / "bin" / name
    program.parent.mkdir(exist_ok=True)
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    return program


@pytest.mark.parametrize("status", [OK, FAILS, WRONG_INPUT, INCONCLUSIVE, FAILED])
def test_the_job_ends_with_the_status_of_the_run(action, job, tmp_path, status):
    program = stub(tmp_path, "fscm-bench", f'echo "$@" >> calls.txt\n[ "$1" = run ] && exit {status}\nexit 0')
    judge = step(action, "Judge")
    variables = environment(judge, defaults(action, model="a b", gates="my gates.toml"), tmp_path)
    done = shell(judge["run"], tmp_path, variables, program.parent)
    assert done.returncode == status
    assert (tmp_path / "output.txt").read_text() == f"status={status}\n"
    assert ("::error::inconclusive" in done.stdout) == (status == INCONCLUSIVE)
    variables = job["variables"] | {"FSCM_BENCH_MODEL": "a b"}
    assert shell("\n".join(job["script"]), tmp_path, variables, program.parent).returncode == status
    assert (tmp_path / "calls.txt").read_text().splitlines() == [
        "run --tier quick --model a b --gates my gates.toml --random 20 --seed 17 --out fscm-bench-results",
        "check-model a",
        "check-model b",
        "run --tier quick --model a b --random 20 --seed 18 --out fscm-bench-results",
    ]


@pytest.mark.heavy
def test_the_steps_judge_a_model_and_write_the_report(action, tmp_path):
    (tmp_path / "mine.py").write_text(MODEL)
    (tmp_path / "gates.toml").write_text(GATES)
    # The program of this environment, whatever is installed where.
    program = stub(tmp_path, "fscm-bench", f'PYTHONPATH="{ROOT}" exec "{sys.executable}" -m comparisons "$@"')
    inputs = defaults(action, model="mine.py:Mine", gates="gates.toml")
    for name in ("Judge", "Write the report"):
        ci_step = step(action, name)
        done = shell(ci_step["run"], tmp_path, environment(ci_step, inputs, tmp_path), program.parent)
        assert done.returncode == 0, done.stderr
    written = {path.name for path in (tmp_path / "fscm-bench-results").iterdir()}
    assert {"run.json", "junit.xml", "report.html"} <= written
    assert (tmp_path / "output.txt").read_text() == "status=0\n"
