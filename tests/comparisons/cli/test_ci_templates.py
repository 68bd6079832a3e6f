"""The action of GitHub and the template of GitLab: they parse, are pinned, and their commands run here."""

import re
import subprocess
import sys

import pytest
import yaml

from comparisons.cli.main import _parser, main
from comparisons.console.exit_status import FAILED, FAILS, INCONCLUSIVE, OK, WRONG_INPUT
from tests.paths import ROOT

ACTION = ROOT / ".github" / "actions" / "fscm-bench" / "action.yml"
GITLAB = ROOT / "docs" / "ci" / "gitlab.yml"


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
    assert len(workflows) == 5
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


def shell(script, folder, variables, path):
    """Run a script as a CI system does: it ends at the first command that fails."""
    # Seeds are below 2^32; identifiers of runs are not.
    base = {"PATH": f"{path}:/usr/bin:/bin", "GITHUB_RUN_ID": str(2**32 + 17), "CI_PIPELINE_ID": str(2**32 + 18)}
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
    program = stub(tmp_path, "pip", 'echo "$@"')
    install, folder, variables = of_new_model(tmp_path, "pip install")
    done = shell(install, folder, variables, program.parent)
    assert (done.returncode != 0, done.stdout) == (True, "")
    done = shell(install, folder, {"FSCM_BENCH": "a.whl"}, program.parent)
    assert done.stdout.splitlines() == ["install a.whl", "install fscm-bench[report] .[test]"]


def of_new_model(tmp_path, words):
    """The script with these words in the workflow of a new model, a folder, and the variables of the workflow."""
    assert main(["new-model", str(tmp_path / "my-model")]) == 0
    workflow = yaml.safe_load((tmp_path / "my-model" / ".github" / "workflows" / "judge.yml").read_text())
    scripts = [ci_step.get("run", "") for ci_step in workflow["jobs"]["judge"]["steps"]]
    (script,) = [script for script in scripts if words in script]
    return script, tmp_path, workflow["env"]


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
    done = shell(*of_new_model(tmp_path, "status=0"), program.parent)
    assert (done.returncode, "::error::inconclusive" in done.stdout) == (status, status == INCONCLUSIVE)
    calls = (tmp_path / "calls.txt").read_text().splitlines()
    for call in calls:
        _parser(call.split()[:1]).parse_args(call.replace("my gates", "gates").split())
    assert calls == [
        "run --tier quick --model a b --gates my gates.toml --random 20 --seed 17 --out fscm-bench-results",
        "check-model a",
        "check-model b",
        "run --tier quick --model a b --random 20 --seed 18 --out fscm-bench-results",
        "run --model my-model --gates gates.toml --random 20 --seed 17 --out results",
    ]
