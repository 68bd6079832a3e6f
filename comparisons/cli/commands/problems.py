"""``fscm-bench new-problem``: a commented problem file of kinds that are named."""

from __future__ import annotations

import argparse
from pathlib import Path
from shlex import quote

from comparisons.cli.options import command, file, option
from comparisons.console.exit_status import OK
from comparisons.console.progress import log
from comparisons.problem.template import problem_template
from comparisons.runs.atomic_files import writing

#: Where a name alone does not say the section.
_FULL_NAMES = "solid.table where sections share a name, punch_solid.KIND for an elastic punch"


@command(
    option("kinds", metavar="KIND", nargs="*", help=f"see: fscm-bench list kinds; {_FULL_NAMES}"),
    file("--out", default=Path("problem.toml"), help="new file (default: problem.toml); its tables are put beside it"),
)
def new_problem_command(args: argparse.Namespace) -> int:
    """Write a problem file that `describe` reads at once; return the exit status.

    For example::

        fscm-bench new-problem coating ball --out pad.toml
        fscm-bench new-problem solid.table punch.power-law dlvo
    """
    texts = {
        (args.out.parent / name if name else args.out): text for name, text in problem_template(args.kinds).items()
    }
    if existing := [path for path in texts if path.exists()]:
        raise ValueError(f"{existing[0]} exists; give another name with --out, or another folder")
    for path, text in texts.items():
        with writing(path, remedy="choose another one"):
            path.write_text(text, encoding="utf-8")
        print(path)
    log(f"change the values; then: fscm-bench describe {quote(str(args.out))}")
    return OK
