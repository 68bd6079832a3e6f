"""Packaging: declared dependencies, and a complete source distribution."""

import ast
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
from collections.abc import Iterator
from fnmatch import fnmatch
from importlib.metadata import packages_distributions
from pathlib import Path, PurePosixPath

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("fscm", "fem_reference", "comparisons")
CONFIGURATION = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PROJECT, SETUPTOOLS = CONFIGURATION["project"], CONFIGURATION["tool"]["setuptools"]
RUNTIME, EXTRAS = PROJECT["dependencies"], PROJECT["optional-dependencies"]
FOR_TESTS = EXTRAS["test"]

#: Files that the build adds.
BUILT = ("PKG-INFO", "setup.cfg", "*.egg-info/*")
#: Functions whose first argument is the name of a module.
BY_NAME = {"files", "import_module", "importorskip"}


def canonical(requirement: str) -> str:
    """The normalised name (PEP 503) of a requirement."""
    return re.sub(r"[-_.]+", "-", re.split(r"[^A-Za-z0-9._-]", requirement, maxsplit=1)[0]).lower()


def roots(source: str) -> Iterator[str]:
    """The first part of the name of every module that is imported, also by a call such as `import_module("...")`."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            yield node.module.partition(".")[0]
        elif isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in BY_NAME:
            yield from (str(one.value).partition(".")[0] for one in node.args[:1] if isinstance(one, ast.Constant))


def external(*folders: str) -> set[str]:
    """The distributions from which the modules of some folders import."""
    sources = [path.read_text(encoding="utf-8") for folder in folders for path in (ROOT / folder).rglob("*.py")]
    names = {root for source in sources for root in roots(source)} - sys.stdlib_module_names - {*PACKAGES, "__main__"}
    installed = packages_distributions()
    return {canonical(installed.get(name, [name])[0]) for name in names}


def test_every_import_of_the_packages_is_declared_and_nothing_else():
    # An optional package is imported where it is used.
    assert external(*PACKAGES) == {
        canonical(requirement) for requirement in RUNTIME + EXTRAS["cluster"] + EXTRAS["bench"] + EXTRAS["pytest"]
    }


def test_the_tests_need_every_extra():
    assert set(EXTRAS["cluster"]) <= set(FOR_TESTS)


def test_every_import_of_the_tests_is_declared():
    own = {"tests", *(path.stem for path in (ROOT / "tests").rglob("*.py"))}
    declared = {canonical(requirement) for requirement in RUNTIME + FOR_TESTS}
    assert external("tests") - declared - {canonical(name) for name in own} == set()


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("import a.b, c", ["a", "c"]),
        ("def f():\n    from d.e import g", ["d"]),
        ("from . import h", []),
        ("import_module('i.j')\nimportlib.import_module(name)", ["i"]),
    ],
)
def test_imports_are_found(source, expected):
    assert sorted(roots(source)) == expected


@pytest.mark.parametrize("requirement", RUNTIME + FOR_TESTS)
def test_every_requirement_has_a_lower_bound(requirement):
    assert re.fullmatch(r"[A-Za-z0-9-]+>=[0-9.]+", requirement)


def repository() -> set[str]:
    """Every file of the repository: those git has, or without git those that .gitignore does not name."""
    if (ROOT / ".git").exists():
        listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, text=True, check=True)
        return {name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()}
    ignored = [line.rstrip("/") for line in (ROOT / ".gitignore").read_text(encoding="utf-8").split()]
    files = {path.relative_to(ROOT).as_posix() for path in ROOT.rglob("*") if path.is_file()}
    return {name for name in files if not any(_is_under(name, pattern) for pattern in ignored)}


def _is_under(name: str, pattern: str) -> bool:
    if "/" in pattern:
        return name.startswith(f"{pattern}/")
    return any(fnmatch(part, pattern) for part in PurePosixPath(name).parts)


def test_the_wheel_has_every_file_of_the_packages():
    for package in PACKAGES:
        patterns = SETUPTOOLS["package-data"][package]
        packed = {path for pattern in patterns for path in (ROOT / package).glob(pattern)}
        files = {ROOT / name for name in repository() if name.startswith(f"{package}/") and not name.endswith(".py")}
        assert files <= packed


def test_the_source_distribution_has_every_file_of_the_repository(tmp_path):
    copy, dist = tmp_path / "copy", tmp_path / "dist"
    expected = repository()
    for name in expected:
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, copy / name)
    build = "import sys; from setuptools import build_meta; build_meta.build_sdist(sys.argv[1])"
    # Without the isolation of pip and build: nothing is downloaded.
    done = subprocess.run([sys.executable, "-c", build, dist], cwd=copy, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (archive,) = dist.glob("*.tar.gz")
    with tarfile.open(archive) as tar:
        members = {member.name.partition("/")[2] for member in tar if member.isfile()}
    assert sorted(expected - members) == []
    assert [name for name in sorted(members - expected) if not any(fnmatch(name, one) for one in BUILT)] == []
