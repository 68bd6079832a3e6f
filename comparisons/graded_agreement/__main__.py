"""Agreement of both references on graded solids: ``python -m comparisons.graded_agreement FOLDER``.

Every event of every case is solved by both references, kept in two journals in the folder, and compared in the table
``graded_agreement.csv`` there.  An interrupted command loses no solved case: the next one with the same folder goes on.
``--limit N`` solves no more than N missing cases by the finite elements; the integral equation solves those that they
have.  ``--jobs N`` uses N processes; ``--renew`` also writes the table of the committed results.  The exit status is 1
when a row is worse than its limit.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from comparisons.console.exit_status import guarded
from comparisons.data.file_names import BASELINE_FOLDER
from comparisons.graded_agreement.cases import CASES
from comparisons.graded_agreement.solving import finite_elements, integral_equation
from comparisons.graded_agreement.table import TABLE, compared, worse_than_limits
from comparisons.paper.cache import CachedCall, make_calls
from comparisons.runs.atomic_files import atomic, prepare_folder
from comparisons.runs.csv_format import csv_text

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    parser = argparse.ArgumentParser(prog="python -m comparisons.graded_agreement", description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "--limit", type=int, default=len(CASES), help="solve so many missing cases by the finite elements"
    )
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--renew", action="store_true", help="also write the table of the committed results")
    options = parser.parse_args(arguments)
    if options.limit < 0 or options.jobs < 1:
        parser.error(f"limit = {options.limit} is below 0, or jobs = {options.jobs} below 1: both are counts")
    folder = prepare_folder(options.folder)
    cases = CASES[: options.limit]
    both = [
        make_calls(
            [CachedCall.of(solve, case.solid, case.punch, case.mu) for case in cases], folder, options.jobs
        ).results
        for solve in (finite_elements, integral_equation)
    ]
    table = compared(*both)
    targets = [folder / TABLE, *([BASELINE_FOLDER / TABLE] if options.renew else [])]
    for target in targets:
        with atomic(target) as file:
            file.write(csv_text(table).encode())
    bad = worse_than_limits(table)
    print(f"{len(table)} of {3 * len(CASES)} rows, {len(bad)} worse than their limit: {', '.join(map(str, targets))}")
    for line in bad:
        print(f"  {line}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(guarded(main))
