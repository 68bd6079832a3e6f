"""Mutation score: the share of small, wrong changes to the code that the tests notice.

``python -m tests.mutation.score`` applies the mutants of ``mutants.toml``, one at a time, to a copy of the repository,
runs the tests of each there, and keeps the outcomes in ``score.csv``.  Mutants that the table has already are not run
again, so that an interrupted call continues; ``--again`` runs them, ``--only TEXT`` those of the files with that text.
A test that notices a mutant must pass without it.  About an hour on one core.
"""

from __future__ import annotations

import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[2]
MUTANTS, SCORE = Path(__file__).with_name("mutants.toml"), Path(__file__).with_name("score.csv")

#: Seconds after which the tests of a mutant are stopped: one that never ends has been noticed.
LONGEST = 3600.0

NOTICED, NOT_NOTICED = "noticed", "not noticed"


@dataclass(frozen=True, slots=True)
class Mutant:
    """A text of a file, another text in its place, and the tests that must notice it."""

    path: str
    old: str
    new: str
    tests: tuple[str, ...]

    @property
    def key(self) -> tuple[str, str, str]:
        """What identifies it in the table."""
        return self.path, self.old, self.new

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


def stored() -> dict[tuple[str, str, str], dict[str, str]]:
    """Return the rows of the committed table by the key of their mutant."""
    if not SCORE.exists():
        return {}
    with SCORE.open(newline="", encoding="utf-8") as file:
        return {(row["path"], row["old"], row["new"]): row for row in csv.DictReader(file)}


def store(mutant: Mutant, row: dict[str, str]) -> None:
    """Put a row into the table, which has the mutants that there are, in their order; another call may write too."""
    rows = stored() | {mutant.key: row}
    partial = SCORE.with_suffix(f".{os.getpid()}")
    with partial.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ["path", "old", "new", "outcome", "by"], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows[mutant.key] for mutant in mutants() if mutant.key in rows)
    partial.replace(SCORE)


@contextmanager
def copy_of_the_repository() -> Iterator[Path]:
    """A copy of the files that are under version control, or would be."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, capture_output=True, check=True,
    )  # fmt: skip
    with TemporaryDirectory() as folder:
        for name in listed.stdout.decode().split("\0"):
            if name and (ROOT / name).is_file():
                target = Path(folder, name)
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, target)
        yield Path(folder)


def first_failure(tests: tuple[str, ...], copy: Path) -> str:
    """Run tests in a copy; return what noticed the change, or an empty text."""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-o", "addopts="]
    environment = {
        **os.environ,
        "PYTHONPATH": str(copy),
        "PYTHONDONTWRITEBYTECODE": "1",
        "OPENBLAS_NUM_THREADS": "1",
    }
    for test in tests:
        call = [*command, "--import-mode=importlib", "-m", "not heavy and not lint", test]
        try:
            run = subprocess.run(call, cwd=copy, env=environment, capture_output=True, text=True, timeout=LONGEST)
        except subprocess.TimeoutExpired:
            return f"{test}: did not end"
        if run.returncode not in (0, 1, 2):
            raise RuntimeError(f"{' '.join(call)} ended with the status {run.returncode}: {run.stdout[-2000:]}")
        if run.returncode:
            found = re.search(r"^(?:FAILED|ERROR) ([^\s\[]+)", run.stdout, re.MULTILINE)
            return found[1] if found else test
    return ""


@cache
def _check_without(test: str, copy: Path) -> None:
    """Refuse a test that fails without a mutant, too: it says nothing about one."""
    if first_failure((test,), copy):
        raise RuntimeError(f"{test} fails without a mutant, too")


def outcome(mutant: Mutant, copy: Path) -> dict[str, str]:
    """Apply a mutant to a copy, run its tests, and restore the file."""
    path = copy / mutant.path
    before = path.read_bytes()
    path.write_text(mutant.text(copy), encoding="utf-8")
    try:
        by = first_failure(mutant.tests, copy)
    finally:
        path.write_bytes(before)
    if "::" in by:
        _check_without(by, copy)
    key = {"path": mutant.path, "old": mutant.old, "new": mutant.new}
    return key | {"outcome": NOTICED if by else NOT_NOTICED, "by": by}


def main(arguments: list[str]) -> int:
    """Run the mutants that the table does not have; 0 if all of them are noticed."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation.score", description=__doc__)
    parser.add_argument("--only", default="", metavar="TEXT", help="mutants of the files with this text in their path")
    parser.add_argument("--again", action="store_true", help="run also those that the table has")
    parser.add_argument("--survivors", action="store_true", help="run also those that were not noticed")
    args = parser.parse_args(arguments)
    rows = stored()
    chosen = [mutant for mutant in mutants() if args.only in mutant.path]
    with copy_of_the_repository() as copy:
        for mutant in chosen:
            row = rows.get(mutant.key)
            survived = row is not None and row["outcome"] == NOT_NOTICED
            if row is None or args.again or (args.survivors and survived):
                rows[mutant.key] = row = outcome(mutant, copy)
                store(mutant, row)
                print(f"{row['outcome']:12} {mutant.path}: {mutant.old!r} -> {mutant.new!r}  {row['by']}", flush=True)
    found = [rows[mutant.key]["outcome"] == NOTICED for mutant in chosen]
    print(f"{sum(found)} of {len(found)} mutants are noticed")
    return 0 if all(found) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
