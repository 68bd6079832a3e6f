"""Baseline: the committed results, as CSV with 17 digits so that every change is visible.

``python -m comparisons.baseline FOLDER`` renews them from the folder of a finished ``fscm-bench run``,
``fscm-bench paper`` or ``fscm-bench bench``.  A run of the quick tier gives the results, the curves, the largest errors
and their pictures.  A run of the full tier gives the agreement of the two references, of which the
quick tier has a few cases only.  ``fscm-bench paper`` gives the figures of the paper, ``fscm-bench bench`` the
benchmark.

``python -m comparisons.baseline --check FOLDER`` changes nothing.  It lists the results of a run, or the tables of the
paper's figures, that differ from the committed ones: values by more than their bounds, or bounds by a factor.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.bench import run as bench
from comparisons.console.exit_status import guarded
from comparisons.data.file_names import (
    AGREEMENT,
    BASELINE_FOLDER,
    CURVES,
    KAPPA_FIGURE,
    LARGEST_KAPPA,
    RECORD,
    REFERENCES,
    RESULTS,
    committed,
)
from comparisons.paper import baseline as paper_baseline
from comparisons.runs.atomic_files import write_file
from comparisons.runs.csv_format import csv_text, read_table
from comparisons.runs.frames import with_problem
from comparisons.runs.record import check_files, read_record
from comparisons.runs.rows import CASE

#: Folder of the committed results, in a clone of the repository.
BASELINE = BASELINE_FOLDER

_KEY = ["model", "quantity", *CASE]
#: By tier, the committed name of each file and its name in the folder of the run.
_FILES = {
    "quick": {
        "quick.csv": f"{RESULTS}.csv",
        "curves.csv": f"{CURVES}.csv",
        **{name: name for name in (f"{LARGEST_KAPPA}.csv", f"{KAPPA_FIGURE}.png", f"{KAPPA_FIGURE}.pdf")},
        f"{REFERENCES}.png": f"{REFERENCES}.png",
    },
    "full": {f"references_agreement.{suffix}": f"{AGREEMENT}.{suffix}" for suffix in ("csv", "png")},
}
#: The columns of tables that are not copied: without those that depend on the machine or on the work done (seconds,
#: iterations, residual).
_COLUMNS = {
    "quick.csv": [*_KEY, "value", "u_num", "status", "reason"],
    "curves.csv": [*_KEY, "point", "x", "y", "u_distance", "status", "reason"],
}

#: A bound that is so many times the stored one, or so small a part of it, has drifted.  On one machine bounds repeat
#: to the last digits.
LARGEST_CHANGE_OF_BOUND = 3.0
#: Least part of a value of size one that counts as a bound.  A smaller one is rounding, which differs between
#: processors (3.5e-14 on one and 1.5e-13 on another were measured), or zero.
_ROUNDING = 1e-13


def renew(folder: Path, target: Path = BASELINE) -> list[Path]:
    """Replace the committed files by those of a run, as far as its tier makes them; return their paths.

    Raises
    ------
    ValueError
        If it is no finished run, lacks a file, was changed, or has other models or cases than the standing ones;
        nothing is changed then.
    """
    arguments = _standing_run(folder)
    for option in ("model", "gates"):
        if arguments[option] is not None:
            raise ValueError(
                f"{folder} is of a run with --{option} {arguments[option]}: the baseline needs a run without it"
            )
    contents = {}
    for name, source in _FILES[arguments["tier"]].items():
        if not (folder / source).exists():
            raise ValueError(f"{folder} lacks {source}: renew the baseline from the folder of `fscm-bench run --pdf`")
        contents[name] = (folder / source).read_bytes()
        if name in _COLUMNS:
            table = read_table(folder / source)
            contents[name] = csv_text(table[[column for column in _COLUMNS[name] if column in table]]).encode()
    target.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_file(target / name, content)
    return [target / name for name in contents]


def _standing_run(folder: Path) -> dict[str, Any]:
    """Return the arguments of a run of the standing cases."""
    record = read_record(folder / RECORD)
    check_files(record, folder)
    arguments: dict[str, Any] = record["arguments"]
    if arguments.get("tier") is None:
        raise ValueError(f"{folder} is not the folder of a run of the standing cases: give one of `fscm-bench run`")
    return arguments


def read_baseline(target: Path | None = None) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the committed results and curves as tables fit for `comparisons.judging.judge.judge`.

    Parameters
    ----------
    target : Path, optional
        Their folder, if not the one that `comparisons.data.file_names` finds.

    Raises
    ------
    ValueError
        If they are not there.
    """
    results, curves = (read_table(target / name if target else committed(name)) for name in _COLUMNS)
    return results, curves


def drift(stored: pd.DataFrame, computed: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of `computed` that differ from the stored ones by more than both uncertainties, or in them.

    Parameters
    ----------
    stored, computed : DataFrame
        Results; rows that are stored and not computed do not matter.

    Returns
    -------
    DataFrame
        The key, both values and both statuses of every row that has drifted or is not stored.
    """
    stored, computed = with_problem(stored), with_problem(computed)
    both = computed.merge(stored, on=_KEY, how="left", suffixes=("", "_stored"), validate="one_to_one")
    apart = (both["value"] - both["value_stored"]).abs() > both["u_num"] + both["u_num_stored"]
    least = _ROUNDING * both["value"].abs().clip(lower=1.0)
    bound, bound_stored = (both[name].clip(lower=least) for name in ("u_num", "u_num_stored"))
    change = bound / bound_stored
    drifted = apart | (change > LARGEST_CHANGE_OF_BOUND) | (change < 1.0 / LARGEST_CHANGE_OF_BOUND)
    drifted |= both["status"] != both["status_stored"]
    return both.loc[drifted, [*_KEY, "value", "value_stored", "u_num", "u_num_stored", "status", "status_stored"]]


def check(folder: Path) -> pd.DataFrame:
    """Return the results of a run that differ from the committed ones, as `drift` does.

    A run of the quick tier is compared with `read_baseline`, one of the full tier with the committed agreement of both
    references.

    Raises
    ------
    ValueError
        If it is no finished run, or a file of it was changed.
    """
    if _standing_run(folder)["tier"] == "quick":
        return drift(read_baseline()[0], read_table(folder / f"{RESULTS}.csv"))
    paths = (committed(f"references_{AGREEMENT}.csv"), folder / f"{AGREEMENT}.csv")
    stored, computed = (_by_model(read_table(path)) for path in paths)
    missing = stored.merge(computed[_KEY], on=_KEY, how="left", indicator=True)["_merge"] == "left_only"
    lost = stored[missing].assign(status="missing", value=float("nan"), u_num=float("nan"))
    return drift(stored, pd.concat([computed, lost], ignore_index=True))


def _by_model(agreement: pd.DataFrame) -> pd.DataFrame:
    """Return the results of both references in a table of their agreement, with the columns of `drift`.

    Cases of problem files are judged by gates alone.
    """
    agreement = with_problem(agreement.dropna(subset="mu"))
    of_reference = agreement.drop(columns=["model", "value", "u_num", "nu"]).rename(
        columns={"reference": "model", "reference_value": "value", "u_reference": "u_num"}
    )
    both = pd.concat([agreement, of_reference.assign(nu=float("nan"))], ignore_index=True)
    return both[[*_KEY, "value", "u_num"]].drop_duplicates(_KEY, ignore_index=True).assign(status="ok")


def main(arguments: Sequence[str]) -> int:
    """Renew the baseline from a folder, or compare the folder with it.

    Returns
    -------
    int
        0 if all is well, 1 if results differ, 2 if the folder or the working folder is a wrong one, 4 if something
        cannot be written.
    """
    return guarded(lambda: _task(arguments), "python -m comparisons.baseline")


def _task(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m comparisons.baseline", description=__doc__)
    parser.add_argument("--check", action="store_true", help="change nothing, and list the results that differ")
    parser.add_argument(
        "folder", metavar="FOLDER", type=Path, help="of a finished run, of the paper, or of the benchmark"
    )
    args = parser.parse_args(arguments)
    of_paper = paper_baseline.has_figures(args.folder)
    of_bench = bench.has_bench(args.folder)
    if args.check:
        if of_bench:
            raise ValueError(f"{args.folder} has a benchmark, whose times another run does not repeat: omit --check")
        different = paper_baseline.check(args.folder) if of_paper else check(args.folder)
        print(f"{args.folder} agrees with the baseline" if different.empty else csv_text(different))
        return 0 if different.empty else 1
    if of_bench:
        paths = bench.renew(args.folder)
    else:
        paths = paper_baseline.renew(args.folder) if of_paper else renew(args.folder)
    print(f"{args.folder} renewed {len(paths)} files of {paths[0].parent}; nothing else was changed.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
