"""Packaging: declared dependencies, a complete source distribution, and a wheel that works outside a clone."""

import re
import runpy
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from fnmatch import fnmatch
from importlib.metadata import packages_distributions

import pytest
import yaml

from comparisons.runs.environment import NOT_INSTALLED, code_digest
from tests.paths import ROOT
from tests.test_independence import PACKAGES, imports_of

CONFIGURATION = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PROJECT = CONFIGURATION["project"]
RUNTIME, EXTRAS = PROJECT["dependencies"], PROJECT["optional-dependencies"]
FOR_TESTS = EXTRAS["test"]

#: Files that the build adds.
BUILT = ("PKG-INFO", "setup.cfg", "*.egg-info/*")


def canonical(requirement: str) -> str:
    """The normalised name (PEP 503) of a requirement."""
    return re.sub(r"[-_.]+", "-", re.split(r"[^A-Za-z0-9._-]", requirement, maxsplit=1)[0]).lower()


def external(*folders: str) -> set[str]:
    """The distributions from which the modules of some folders import."""
    paths = [path for folder in folders for path in (ROOT / folder).rglob("*.py")]
    names = {name.partition(".")[0] for path in paths for name in imports_of(path)} - sys.stdlib_module_names
    names -= {*PACKAGES, "__main__", "fscm_bench", ""}
    installed = packages_distributions()
    return {canonical(installed.get(name, [name])[0]) for name in names}


def test_every_import_of_the_packages_is_declared_and_nothing_else():
    # An optional package is imported where it is used.
    optional = [requirement for name in ("report", "pytest", "afm", "peers") for requirement in EXTRAS[name]]
    assert external(*PACKAGES) == {canonical(requirement) for requirement in RUNTIME + optional}


def test_every_import_of_the_tests_is_declared():
    modules = {"tests", *(path.stem for folder in ("tests", "docs") for path in (ROOT / folder).rglob("*.py"))}
    # A heavy test has the notebooks run by Jupyter; that of the other code is skipped where it is not installed.
    declared = {canonical(requirement) for requirement in RUNTIME + FOR_TESTS + EXTRAS["docs"] + EXTRAS["peers"]}
    assert external("tests") - declared - {canonical(name) for name in modules} == set()


def repository() -> set[str]:
    """Every file that git has."""
    if not (ROOT / ".git").exists():
        pytest.skip("these are the files of a source distribution")
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, text=True, check=True)
    return {name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()}


#: Without the isolation of pip and build: nothing is downloaded.
BUILD = "import sys; from setuptools import build_meta; build_meta.build_{kind}(sys.argv[1])"


def built(kind, source, dist):
    done = subprocess.run(
        [sys.executable, "-c", BUILD.format(kind=kind), dist], cwd=source, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    (path,) = dist.iterdir()
    return path


@pytest.fixture(scope="module")
def source_distribution(tmp_path_factory):
    """The source distribution, unpacked."""
    folder = tmp_path_factory.mktemp("source")
    copy, dist = folder / "copy", folder / "dist"
    for name in repository():
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, copy / name)
    with tarfile.open(built("sdist", copy, dist)) as tar:
        tar.extractall(folder / "unpacked", filter="data")
    (unpacked,) = (folder / "unpacked").iterdir()
    return unpacked


@pytest.fixture(scope="module")
def wheel(source_distribution, tmp_path_factory):
    """The wheel that the unpacked source distribution makes, unpacked as pip does it."""
    folder = tmp_path_factory.mktemp("wheel")
    with zipfile.ZipFile(built("wheel", source_distribution, folder / "dist")) as archive:
        archive.extractall(folder / "site-packages")
    return folder / "site-packages"


def files_in(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_the_source_distribution_has_every_file_of_the_repository(source_distribution):
    expected = repository()
    members = {name for name in files_in(source_distribution) if not name.startswith("build/")}
    assert sorted(expected - members) == []
    assert [name for name in sorted(members - expected) if not any(fnmatch(name, pattern) for pattern in BUILT)] == []


def test_the_wheel_has_the_packages_with_their_data(wheel):
    tops = {name.partition("/")[0] for name in files_in(wheel)}
    assert {name for name in tops if not name.endswith(".dist-info")} == {*PACKAGES, "fscm_bench", "fscm_bench_pytest"}
    assert not any((wheel / folder).exists() for folder in NOT_INSTALLED)
    installed = {name for name in repository() if name.partition("/")[0] in PACKAGES and not name.endswith(".py")}
    assert installed <= files_in(wheel)


def test_the_same_code_has_the_same_digest_in_a_clone_and_installed(wheel):
    assert code_digest(wheel) == code_digest(ROOT)


def test_the_constraints_have_the_lowest_version_of_every_requirement():
    assert all(re.fullmatch(r"[A-Za-z0-9-]+>=[0-9.]+", requirement) for requirement in (*RUNTIME, *FOR_TESTS))
    lines = runpy.run_path(str(ROOT / ".github" / "constraints" / "lowest.py"))["constraints"]()
    assert {line.replace("==", ">=") for line in lines} >= {*RUNTIME, *FOR_TESTS}


PAPER = ".github/joss/paper.md"
#: What the release check says of a clone before its owner has written anything, by words of its sentences.
MISSING = (
    "[project.urls]",
    "repository-code",
    "family name",
    "doi: 10",
    "no author",
    "no affiliation",
    "AI usage",
    "Acknow",
)


def test_a_release_needs_its_version_authors_affiliations_address_doi_and_what_the_owner_states(tmp_path):
    (tmp_path / ".github" / "joss").mkdir(parents=True)
    for name in ("pyproject.toml", "CHANGELOG.md", "CITATION.cff", ".github/release_check.py", PAPER):
        (tmp_path / name).write_bytes((ROOT / name).read_bytes())
    problems = runpy.run_path(str(tmp_path / ".github" / "release_check.py"))["problems"]
    tag, address = f"v{PROJECT['version']}", "https://a/b"

    def change(name, *pairs):
        text = (tmp_path / name).read_text(encoding="utf-8")
        for old, new in pairs:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / name).write_text(text, encoding="utf-8")

    assert any("v0.0.9" in line and PROJECT["version"] in line for line in problems("v0.0.9", address))
    found = problems(tag, address)
    assert [[word for word in MISSING if word in line] for line in found] == [[word] for word in MISSING]
    change("pyproject.toml", ("\n[project.scripts]", f'\n[project.urls]\nSource = "{address}"\n\n[project.scripts]'))
    person, facts = "  - family-names: Doe", f"doi: 10.5281/zenodo.1\nrepository-code: {address}\nlicense:"
    change("CITATION.cff", ('  - name: "The fscm-bench developers"', person), ("license:", facts))
    owner = ("[to be stated by the owner", "The owner states [")
    change(PAPER, ("authors: []", "authors:\n  - name: Jane Doe\n    affiliation: 1, 2"), owner)
    change(PAPER, ("affiliations: []", "affiliations:\n  - index: 1\n    name: Some University"))
    (left,) = problems(tag, address)
    assert "Jane Doe" in left
    change(PAPER, ("affiliation: 1, 2", "affiliation: 1"))
    assert problems(tag, address) == []
    assert [line for line in problems(tag, "https://c/d") if "https://c/d" in line and address in line]


def test_the_recipe_of_conda_has_the_requirements_and_the_version_of_the_project():
    text = (ROOT / ".github" / "packaging" / "conda" / "recipe.yaml").read_text(encoding="utf-8")
    recipe = yaml.safe_load(text)
    names = {"matplotlib": "matplotlib-base"}
    needed = (requirement.partition(">=") for requirement in RUNTIME + EXTRAS["report"])
    expected = {f"{names.get(name, name)} >={version}" for name, _, version in needed}
    assert set(recipe["requirements"]["run"]) == expected | {f"python {PROJECT['requires-python']}"}
    assert recipe["context"]["version"] == PROJECT["version"]


@pytest.mark.parametrize("name", sorted(path.name for path in (ROOT / ".github/workflows").iterdir()))
def test_a_workflow_is_pinned_and_has_few_rights(name):
    text = (ROOT / ".github" / "workflows" / name).read_text(encoding="utf-8")
    workflow = yaml.safe_load(text)
    assert workflow["permissions"] == {"contents": "read"}
    assert "pull_request_target" not in text
    used = re.findall(r"uses: (\S+)", text)
    assert used
    assert [action for action in used if not re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", action)] == []
    for job in workflow["jobs"].values():
        assert job.get("permissions", {}) in ({}, {"id-token": "write"}, {"pages": "write", "id-token": "write"})
        for step in job["steps"]:
            done = subprocess.run(["bash", "-n"], input=step.get("run", ""), capture_output=True, text=True)
            assert (done.returncode, done.stderr) == (0, "")
