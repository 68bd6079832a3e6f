"""Mutation score: the share of small, wrong changes to the code that the tests notice.

``python -m tests.mutation.score`` applies the mutants of ``mutants.toml``, one at a time, to a copy of the repository,
runs the tests of each there, and prints the outcomes; ``--only TEXT`` those of the files with that text in their path.
About an hour on one core (360 mutants).
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from compileall import compile_dir
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from py_compile import PycInvalidationMode
from tempfile import TemporaryDirectory, mkdtemp

from tests.marks import LIGHT
from tests.test_independence import PACKAGES

ROOT = Path(__file__).resolve().parents[2]
MUTANTS = Path(__file__).with_name("mutants.toml")

#: Seconds after which the tests of a mutant are stopped: one that never ends has been noticed.
LONGEST = 3600.0


@dataclass(frozen=True, slots=True)
class Mutant:
    """A text of a file, another text in its place, and the tests that must notice it."""

    path: str
    old: str
    new: str
    tests: tuple[str, ...]

    def text(self, root: Path = ROOT) -> str:
        """Return the changed file."""
        text = (root / self.path).read_text(encoding="utf-8")
        if text.count(self.old) != 1:
            raise ValueError(f"{self.path} has {text.count(self.old)} times the text {self.old!r}, not once")
        return text.replace(self.old, self.new)


def mutants() -> list[Mutant]:
    """Return all mutants of the table."""
    tables = tomllib.loads(MUTANTS.read_text(encoding="utf-8"))["file"]
    return [Mutant(table["path"], old, new, tuple(table["tests"])) for table in tables for old, new in table["mutants"]]


@contextmanager
def copy_of_the_repository() -> Iterator[Path]:
    """A copy of its files, but those that are built or belong to git, with bytecode.

    The bytecode is valid by what the source is, not by its time: a mutant is compiled again, and nothing else is.
    """
    with TemporaryDirectory() as folder:
        copy = Path(folder, "copy")
        shutil.copytree(
            ROOT, copy, ignore=shutil.ignore_patterns(".git", ".venv", ".*_cache", "build", "__pycache__", "*.egg-info")
        )
        for package in PACKAGES:
            compile_dir(copy / package, quiet=1, invalidation_mode=PycInvalidationMode.CHECKED_HASH)
        yield copy


def noticed_by(tests: tuple[str, ...], copy: Path) -> str:
    """Run tests in a copy; return what noticed the change, or an empty text.

    A test that a mutant makes fail may leave folders that pytest cannot remove, which would fail every later test: each
    run has a folder of its own.

    Raises
    ------
    RuntimeError
        If pytest cannot run them, or fails without the name of a test.
    """
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-o", "addopts="]
    variables = {"PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1"}
    for test in tests:
        folder = mkdtemp()
        call = [*command, "--import-mode=importlib", "-m", LIGHT, f"--basetemp={folder}/tests", test]
        try:
            run = subprocess.run(
                call, cwd=copy, env=os.environ | variables, capture_output=True, text=True, timeout=LONGEST
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return f"{test}: did not end"
        finally:
            subprocess.run(["rm", "-rf", folder], check=False)
        if run.returncode < 0:
            return f"{test}: ended by {signal.Signals(-run.returncode).name}"
        if run.returncode not in (0, 1, 2):
            raise RuntimeError(f"{' '.join(call)} ended with the status {run.returncode}: {run.stdout[-2000:]}")
        if run.returncode:
            failure = re.search(r"^(?:FAILED|ERROR) (tests/[^\s\[]+)", run.stdout, re.MULTILINE)
            if not failure:
                raise RuntimeError(
                    f"{' '.join(call)} names no test that fails: {run.stdout[-2000:]}{run.stderr[-2000:]}"
                )
            return failure[1]
    return ""


def is_noticed(mutant: Mutant, copy: Path) -> str:
    """Apply a mutant to a copy and run its tests; return what notices it.

    Raises
    ------
    RuntimeError
        If its tests cannot be run, or fail without the mutant, too.
    """
    path = copy / mutant.path
    before = path.read_bytes()
    path.write_text(mutant.text(copy), encoding="utf-8")
    try:
        by = noticed_by(mutant.tests, copy)
    finally:
        path.write_bytes(before)
    is_failure = by and ": " not in by
    if is_failure and noticed_by((by,), copy):
        raise RuntimeError(f"{by} fails without a mutant, too")
    return by


def main(arguments: list[str]) -> int:
    """Run the mutants and print the outcome of each; 0 if all of them are noticed."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation.score", description=__doc__)
    parser.add_argument("--only", default="", metavar="TEXT", help="mutants of the files with this text in their path")
    args = parser.parse_args(arguments)
    selected = [mutant for mutant in mutants() if args.only in mutant.path]
    count = 0
    with copy_of_the_repository() as copy:
        for mutant in selected:
            try:
                by = is_noticed(mutant, copy)
            except RuntimeError as error:
                by, outcome = "", f"ERROR ({error})"
            else:
                outcome = by or "NOT NOTICED"
            count += bool(by)
            print(f"{outcome}  {mutant.path}: {mutant.old!r} -> {mutant.new!r}", flush=True)
    print(f"{count} of {len(selected)} mutants are noticed")
    return 0 if count == len(selected) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
