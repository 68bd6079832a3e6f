"""Committed benchmark: renewed from a folder of ``fscm-bench bench``."""

from __future__ import annotations

import json
from pathlib import Path

from comparisons.bench.run import parts_of
from comparisons.data.file_names import BENCH, BENCH_SUMMARY
from comparisons.paper.baseline import replace_files

#: Folder of the committed benchmark, in a clone of the repository.
BENCH_BASELINE = Path("results", "baseline", "bench")


def has_bench(folder: Path) -> bool:
    """Whether a folder is that of a finished ``fscm-bench bench``."""
    return (folder / BENCH).is_file()


def renew(folder: Path, target: Path = BENCH_BASELINE) -> list[Path]:
    """Replace the committed tables, figures, summary and record by those of a run of all parts; return their paths.

    Raises
    ------
    ValueError
        If the run lacks a part, or a measurement failed; nothing is changed then.
    """
    failures = json.loads((folder / BENCH).read_text(encoding="utf-8"))["failures"]
    if failures:
        raise ValueError(f"{folder} has {failures} failed measurements: repeat `fscm-bench bench`")
    sources = {name: [folder / name] for name in (BENCH, BENCH_SUMMARY)}
    return replace_files(sources | {part.name: part.files(folder) for part in parts_of(None)}, folder, target)
