"""Paths of the files in the folder of a run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from comparisons.data import file_names

__all__ = ["RunFolder"]


@dataclass(frozen=True, slots=True)
class RunFolder:
    """The folder of a run, of a sweep or of the figures of the paper.

    Examples
    --------
    >>> folder = RunFolder(Path("out"))
    >>> folder.record.name, folder.results.name, folder.parquet(folder.results).name
    ('run.json', 'results', 'results.parquet')
    """

    path: Path

    @property
    def record(self) -> Path:
        """The record: where the numbers come from."""
        return self.path / file_names.RECORD

    @property
    def data_package(self) -> Path:
        """The data package: type, unit and meaning of every column of the tables."""
        return self.path / file_names.DATA_PACKAGE

    @property
    def store(self) -> Path:
        """The store of finished computations."""
        return self.path / file_names.STORE

    @property
    def bench(self) -> Path:
        """The record of a benchmark: code and machine."""
        return self.path / file_names.BENCH

    @property
    def bench_summary(self) -> Path:
        """The ratios of a benchmark, as they are printed."""
        return self.path / file_names.BENCH_SUMMARY

    @property
    def gates_text(self) -> Path:
        """The copy of the gates that the run was made with."""
        return self.path / file_names.GATES_TEXT

    @property
    def grid_text(self) -> Path:
        """The copy of the grids, if they are not the standing cases."""
        return self.path / file_names.GRID_TEXT

    @property
    def inputs(self) -> Path:
        """The copies of a problem file and of its tables."""
        return self.path / file_names.INPUTS

    @property
    def results(self) -> Path:
        """Stem of the table of results: without its suffix, as of every table below."""
        return self.path / file_names.RESULTS

    @property
    def curves(self) -> Path:
        """Stem of the table of curves."""
        return self.path / file_names.CURVES

    @property
    def kappa(self) -> Path:
        """Stem of the table of relative errors."""
        return self.path / file_names.KAPPA

    @property
    def largest_kappa(self) -> Path:
        """Stem of the table of the largest relative errors."""
        return self.path / file_names.LARGEST_KAPPA

    @property
    def agreement(self) -> Path:
        """Stem of the table of differences of the two references, and of its picture."""
        return self.path / file_names.AGREEMENT

    @property
    def comparison(self) -> Path:
        """Stem of the table of a comparison, and of its picture."""
        return self.path / file_names.COMPARISON

    @property
    def verdicts(self) -> Path:
        """Stem of the table of verdicts: a row for each gate and case."""
        return self.path / file_names.VERDICTS

    @property
    def gates(self) -> Path:
        """Stem of the table of what the gates required."""
        return self.path / file_names.GATES

    @property
    def summary(self) -> Path:
        """Stem of the summary of verdicts: a row for each gate and candidate."""
        return self.path / file_names.SUMMARY

    @property
    def verdicts_markdown(self) -> Path:
        """The verdicts as Markdown."""
        return self.path / file_names.VERDICTS_MARKDOWN

    @property
    def verdicts_latex(self) -> Path:
        """The verdicts as a table in LaTeX."""
        return self.path / file_names.VERDICTS_LATEX

    @property
    def junit(self) -> Path:
        """The verdicts as JUnit XML."""
        return self.path / file_names.JUNIT

    @property
    def report(self) -> Path:
        """The report, unless the user chooses another place."""
        return self.path / file_names.REPORT

    def parquet(self, stem: Path) -> Path:
        """Return the Parquet file of a table."""
        return stem.with_suffix(".parquet")

    def figure(self, name: str) -> list[Path]:
        """Return the files of a picture: pixels for the screen, vectors for print."""
        return [self.path / f"{name}{suffix}" for suffix in (".png", ".pdf")]
