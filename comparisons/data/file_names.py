"""Names of the files in the folder of a run, and paths of the committed ones."""

from __future__ import annotations

from pathlib import Path

#: The record of the run, and the store of finished computations.
RECORD, STORE = "run.json", "store.sqlite"

#: The lock of the folder.  It stays, empty: its removal would let two commands lock two files of one name.
LOCK = ".lock"

#: The description of a submission to the board, in its folder.
SUBMISSION = "submission.toml"

#: Folder of the committed results, in a clone of the repository.
BASELINE_FOLDER = Path("results", "baseline")

#: The record of a benchmark, and its summary.
BENCH, BENCH_SUMMARY = "bench.json", "bench.txt"

#: Copies of the gates and of the grids of the run, whose own files may change.
GATES_TEXT, GRID_TEXT = "gates.toml", "grid.toml"

#: Folder of the copies of a problem file and of its tables.
INPUTS = "inputs"

#: Tables, each written as CSV.
RESULTS, CURVES, KAPPA, LARGEST_KAPPA, AGREEMENT = "results", "curves", "kappa", "largest_kappa", "agreement"
#: Tables of the gates: a row for each gate and case, what each requires, a row for each gate and candidate.
VERDICTS, GATES, SUMMARY = "verdicts", "gates", "summary"

#: Table and picture of `comparisons.compare`.
COMPARISON = "comparison"
#: Files of `comparisons.compare`.
COMPARISON_FILES = tuple(f"{COMPARISON}.{suffix}" for suffix in ("csv", "png", "pdf"))

#: Pictures: each is written as PNG, and with --pdf as PDF.
KAPPA_FIGURE, REFERENCES, VALUES = "fig16b_kappa", "references", "values"
#: All pictures of a run.
FIGURES = (KAPPA_FIGURE, AGREEMENT, REFERENCES, VALUES)

#: The verdicts as JUnit XML, and the page of `fscm-bench report`.
JUNIT, REPORT = "junit.xml", "report.html"

#: What is written when a run is judged, besides the verdicts in other formats (`is_of_verdicts`).
VERDICT_FILES = (*(f"{table}.csv" for table in (VERDICTS, GATES, SUMMARY)), JUNIT)

#: Files of a run that have a checksum in its record, as far as they exist.
RUN_FILES = (
    *(f"{table}.csv" for table in (RESULTS, CURVES, KAPPA, LARGEST_KAPPA, AGREEMENT)),
    *(f"{figure}.{suffix}" for figure in FIGURES for suffix in ("png", "pdf")),
    *(GATES_TEXT, GRID_TEXT),
    *VERDICT_FILES,
    *COMPARISON_FILES,
)


def is_of_verdicts(name: str) -> bool:
    """Whether a file is written when a run is judged: one of `VERDICT_FILES`, or the verdicts in any other format.

    Examples
    --------
    >>> [is_of_verdicts(name) for name in ("verdicts.adoc", "junit.xml", "gates.toml")]
    [True, True, False]
    """
    return name in VERDICT_FILES or name.startswith(f"{VERDICTS}.")


#: The clone whose packages run.
_CLONE = Path(__file__).resolve().parents[2]


def committed(name: str | Path) -> Path:
    """Return the path of a file or folder of the baseline, in the working folder or in the clone whose packages run.

    Parameters
    ----------
    name : str or Path
        Relative to the folder of the baseline; a folder has to have a file.

    Raises
    ------
    ValueError
        If it is in neither of them.

    Examples
    --------
    >>> committed("quick.csv").name, committed("paper").name
    ('quick.csv', 'paper')
    """
    for folder in (BASELINE_FOLDER, _CLONE / BASELINE_FOLDER):
        path = folder / name
        if path.is_file() or (path.is_dir() and any(path.iterdir())):
            return path
    raise ValueError(f"{BASELINE_FOLDER / name} of the baseline is missing: call this in the root folder of a clone")
