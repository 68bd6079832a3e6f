"""``fscm-bench fit``: work of adhesion, modulus and other values of a problem file, from measured curves."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from comparisons.cli.options import JOBS, command, file, option, output_format, several
from comparisons.cli.screen import output, print_text
from comparisons.console.exit_status import FAILED, OK
from comparisons.console.progress import log, note
from comparisons.description.budget import budget_line
from comparisons.fitting.baseline import BASELINES
from comparisons.fitting.folder import MOST_PICTURES, fit_files
from comparisons.fitting.reading import SIGNALS, Sensitivity
from comparisons.fitting.table import CAPTION, fit_columns, fit_rows
from comparisons.output.table import cells
from comparisons.output.terminal import rich_table
from comparisons.problem import Problem
from comparisons.problem.units import NotAValue, in_si, si_text

#: A curve with its fit or failure, as of `fit_files`.
_Item = Mapping[str, Any]

#: Most curves that are all printed, and how many of more are printed at either end.
_MOST_SHOWN, _AT_AN_END = 50, 5


@command(
    file("curves", metavar="CURVE", nargs="*", help="CSV with displacement [nm] and load [nN], or an AFM file"),
    file("--problem", required=True, help="a problem file; the fit starts from its values"),
    several("--free", metavar="KEY", required=True, help="keys of the problem file to fit, as solid.E"),
    option("--model", choices=("fscm", "jkr"), help="(default: fscm, and jkr where the two agree)"),
    option("--branch", choices=("approach", "retreat", "both"), default="both", help="(default: both)"),
    option("--baseline", choices=BASELINES, help="load without contact (default: linear where the record shows it)"),
    option("--stiffness", metavar="VALUE", help='cantilever stiffness, as "0.2 N/m" (default: displacement control)'),
    option("--sensitivity", metavar="VALUE", help='deflection sensitivity, as "50 nm/V", per A or per count'),
    file("--out", metavar="DIR", help="folder for table, JSON and pictures; fits in it are kept"),
    option("--pictures", action="store_true", help=f"a picture of each curve, also of more than {MOST_PICTURES}"),
    JOBS,
    output_format("json"),
)
def fit_command(args: argparse.Namespace) -> int:
    """Fit and print; return the exit status.

    For example::

        fscm-bench fit curve.csv --problem probe.toml --free law.work_of_adhesion solid.E
        fscm-bench fit *.jpk-force --problem probe.toml --free solid.E --stiffness '0.2 N/m' --out fits
    """
    problem = Problem.load(args.problem)
    curves, keys = _curves_and_keys(args.curves, args.free)
    instrument = {
        "stiffness": None if args.stiffness is None else _si("stiffness", args.stiffness, "N/m"),
        "sensitivity": _sensitivity(args.sensitivity),
    }
    items = fit_files(
        curves,
        problem,
        keys,
        args.out,
        args.jobs,
        pictures=args.pictures,
        model=args.model,
        branch=args.branch,
        baseline=args.baseline,
        **instrument,
    )
    fits = [fitted | {"position": item["position"]} for item in items for fitted in item["fits"]]
    if args.format == "json":
        failures = [
            {name: item[name] for name in ("curve", "failure", "position")} for item in items if item["failure"]
        ]
        print(json.dumps(fits[0] if len(fits) == 1 and not failures else {"fits": fits, "failures": failures}))
    elif fits:
        shown, left_out = _ends(items)
        output().print(rich_table(_cells(shown, left_out), CAPTION))
        print_text(_left_out(left_out, args.out))
        print_text(line for item in shown for fitted in item["fits"] for line in _lines(fitted, len(items) > 1))
    failed, left_out = _ends([item for item in items if item["failure"]])
    for item in failed:
        log(f"{item['curve']}: {item['failure']}")
    if left_out:
        log(f"{left_out} more curves have no fit")
    if args.out is not None:
        note(f"fits.csv, fits.json, fits.tex and {_pictures(len(items), args.pictures)} are in {args.out}")
    return FAILED if any(item["failure"] for item in items) else OK


def _curves_and_keys(curves: Sequence[Path], words: Sequence[str]) -> tuple[list[Path], list[str]]:
    """Return the curves and the keys to fit: --free takes the words behind it, the curves among them, too."""
    behind = [Path(word) for word in words if Path(word).is_file()]
    keys = [word for word in words if Path(word) not in behind]
    if missing := [path for path in curves if not path.exists()]:
        raise ValueError(f"there is no file {missing[0]}; check the name")
    if not (curves or behind) or not keys:
        lacks = "keys to fit" if curves or behind else "a measured curve, or its file does not exist"
        raise ValueError(f"the command lacks {lacks}: write fscm-bench fit CURVE ... --problem FILE --free KEY ...")
    return [*curves, *behind], keys


def _ends(items: Sequence[_Item]) -> tuple[list[_Item], int]:
    """Return the first and the last of many curves, or all of a few, and how many are between them."""
    left_out = len(items) - 2 * _AT_AN_END
    if len(items) <= _MOST_SHOWN:
        return [*items], 0
    return [*items[:_AT_AN_END], *items[-_AT_AN_END:]], left_out


def _cells(shown: Sequence[_Item], left_out: int) -> dict[str, list[str]]:
    """Return the texts of the table, with a row of dots where curves are left out."""
    texts = cells(fit_columns(rows := fit_rows(shown)), rows)
    if left_out:
        gap = len(fit_rows(shown[:_AT_AN_END]))
        for column in texts.values():
            column.insert(gap, "...")
    return texts


def _left_out(count: int, folder: Path | None) -> list[str]:
    """Say where the curves are that the table leaves out."""
    if not count:
        return []
    where = "--out DIR writes all of them" if folder is None else f"all of them are in {folder / 'fits.csv'}"
    return [f"{count} more curves: {where}"]


def _pictures(count: int, of_each: bool) -> str:
    """Say which pictures a folder has."""
    if of_each or count <= MOST_PICTURES:
        return "a picture of each curve and map"
    return f"a picture of each map (and of each curve with --pictures: there are more than {MOST_PICTURES})"


def _si(name: str, text: str, unit: str) -> float:
    try:
        value = in_si(text, unit)
    except NotAValue as error:
        raise ValueError(f"--{name} {text} {error}") from None
    if not value > 0.0:
        raise ValueError(f"--{name} {text} is not above 0")
    return value


def _sensitivity(text: str | None) -> Sensitivity | None:
    """Return the deflection for a signal in volts, amperes or counts."""
    if text is None:
        return None
    for signal in SIGNALS:
        try:
            in_si(text, f"m/{signal}")
        except NotAValue:
            continue
        return Sensitivity(_si("sensitivity", text, f"m/{signal}"), signal)
    return Sensitivity(_si("sensitivity", text, "m/V"))


def _lines(fitted: dict[str, Any], several_curves: bool) -> list[str]:
    """Return residual and noise, and what the curve does not determine."""
    name = f"{fitted['curve']}: " if several_curves else ""
    share = fitted["residual"] / fitted["noise"]
    lines = [f"{name}residuals are {share:.2g} times the noise of {fitted['noise'] * 1e9:.3g} nN"]
    if share > 2.0:
        lines.append(f"{name}the model does not describe the curve: u is too small")
    values = [row for row in fitted["parameters"].values() if row["determined"] and row["value"]]
    bound = min((row["u"] / abs(row["value"]) for row in values), default=0.0)
    lines += [
        f"{name}{key}: the file has {si_text(row['start'], row['prior'], row['unit'])}"
        for key, row in fitted["parameters"].items()
        if row["prior"] is not None
    ]
    if line := budget_line(fitted.get("assumptions"), bound):
        lines.append(f"{name}{line}")
    return lines + [f"{name}{remark}" for remark in fitted["remarks"]]
