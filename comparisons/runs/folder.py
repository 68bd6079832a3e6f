"""Paths of the files in the folder of a run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from comparisons.data import file_names as names

__all__ = ["RunFolder"]


class _File:
    """Attribute of a folder: the path of the file, or of the stem of a table and its picture, of that name."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, folder: RunFolder, owner: type) -> Path:
        return folder.path / self._name


@dataclass(frozen=True)
class RunFolder:
    """The folder of a run, of a sweep or of the figures of the paper.

    `comparisons.data.file_names` describes its files.

    Examples
    --------
    >>> folder = RunFolder(Path("out"))
    >>> folder.record.name, folder.results.name, folder.parquet(folder.results).name
    ('run.json', 'results', 'results.parquet')
    """

    path: Path

    record = _File(names.RECORD)
    store = _File(names.STORE)
    bench = _File(names.BENCH)
    bench_summary = _File(names.BENCH_SUMMARY)
    gates_text = _File(names.GATES_TEXT)
    grid_text = _File(names.GRID_TEXT)
    inputs = _File(names.INPUTS)
    results = _File(names.RESULTS)
    curves = _File(names.CURVES)
    kappa = _File(names.KAPPA)
    largest_kappa = _File(names.LARGEST_KAPPA)
    agreement = _File(names.AGREEMENT)
    comparison = _File(names.COMPARISON)
    verdicts = _File(names.VERDICTS)
    gates = _File(names.GATES)
    summary = _File(names.SUMMARY)
    verdicts_markdown = _File(names.VERDICTS_MARKDOWN)
    verdicts_latex = _File(names.VERDICTS_LATEX)
    junit = _File(names.JUNIT)
    report = _File(names.REPORT)

    def parquet(self, stem: Path) -> Path:
        """Return the Parquet file of a table."""
        return stem.with_suffix(".parquet")

    def figure(self, name: str) -> list[Path]:
        """Return the files of a picture: pixels for the screen, vectors for print."""
        return [self.path / f"{name}{suffix}" for suffix in (".png", ".pdf")]
