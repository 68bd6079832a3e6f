"""``fscm-bench paper``: compute every figure of the paper again, its data beside it."""

from __future__ import annotations

import argparse
from collections import Counter
from concurrent.futures import BrokenExecutor
from contextlib import closing
from pathlib import Path

from comparisons.cli.options import FAILED, OK, output
from comparisons.console.progress import counting, log
from comparisons.model import ComputationFailed
from comparisons.paper.cache import CallCache
from comparisons.paper.paper_figure import write
from comparisons.paper.registry import NAMES, paper_figures
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.computation import add_jobs, add_retry_failed, checked_jobs, say_failures_used
from comparisons.runs.environment import fingerprint
from comparisons.runs.journal import alone_in

__all__ = ["add", "call"]


def add(parsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the arguments."""
    parser = parsers.add_parser(
        "paper", help="the figures and numbers of the paper, computed again", description=__doc__
    )
    parser.add_argument(
        "--figure", metavar="N", nargs="+", action="extend", help=f"only these of {', '.join(NAMES)} (default: all)"
    )
    add_jobs(parser)
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        default=Path("results", "runs", "paper"),
        help="folder for the files (default: %(default)s); resumed if it has some answers",
    )
    add_retry_failed(parser)
    parser.set_defaults(call=call)


def call(args: argparse.Namespace) -> int:
    """Compute what is missing, write the figures, name their files; return the exit status."""
    jobs = checked_jobs(args.jobs)
    chosen = paper_figures(args.figure)
    folder = prepare_folder(args.out)
    tasks = [call for figure in chosen for call in figure.tasks()]
    try:
        with alone_in(folder):
            cache = CallCache(folder / "tasks.jsonl", fingerprint())
            failed = cache.failed(tasks)
            if args.retry_failed:
                cache.forget(failed)
            else:
                say_failures_used(Counter(call.function.partition(":")[2] for call in failed))
            waiting = cache.missing(tasks)
            with counting("paper", len(waiting)) as advance, closing(cache.work(waiting, jobs)) as done:
                for _ in done:
                    advance()
    except KeyboardInterrupt:
        log(f"what is finished is kept in {folder}; the same command goes on")
        raise
    except BrokenExecutor:
        log(f"a worker process died (out of memory?); what is finished is kept in {folder}; the same command goes on")
        return FAILED
    shown, status = output(), OK
    for figure in chosen:
        try:
            tables = figure.tables(cache.answers)
            written = write(figure, tables, folder)
        except ComputationFailed as failure:
            log(f"{figure.stem}: {failure}")
            status = FAILED
            continue
        kinds = Counter(path.suffix[1:] for path in written)
        shown.print(f"{figure.stem}: {figure.title} ({', '.join(f'{count} {kind}' for kind, count in kinds.items())})")
        if figure.shown:
            shown.print(figure.shown(tables))
    shown.print(f"written to {folder}")
    return status
