"""Fast and slow tests of the solvers under other kernels of OpenBLAS, which round in another way than this machine's.

``python -m tests.blas.kernels`` runs them under the first kernel of the table that is not the machine's own; ``--all``
under every kernel, with one thread and with two.  The machine's own kernel with one thread is that of the tests
themselves.  Further arguments are those of pytest: ``python -m tests.blas.kernels -n 2``.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.marks import LIGHT

ROOT = Path(__file__).resolve().parents[2]

#: With fused multiplication and addition and without, vectors of 2, 4 and 8 numbers; the most frequent one first.
KERNELS = ("Haswell", "Nehalem", "Sandybridge", "SkylakeX")

#: What BLAS rounds in: the solvers, their agreement, the certified values, and whether a kernel is in force.
TESTS = ("tests/blas", "tests/fscm", "tests/fem_reference", "tests/solvers", "tests/certified")

#: Prints the kernel of each BLAS that is loaded, after a use of it.
_PROBE = """
import json

import numpy as np
import scipy.linalg
from threadpoolctl import threadpool_info

matrix = np.vander(np.linspace(0.1, 1.0, 200), 40)
np.linalg.lstsq(matrix, matrix[:, 0], rcond=1e-14)
scipy.linalg.lstsq(matrix, matrix[:, 0], lapack_driver="gelsy")
scipy.linalg.eigh(matrix.T @ matrix + np.eye(40))
loaded = [library for library in threadpool_info() if library["user_api"] == "blas"]
print(json.dumps([library.get("architecture", library["internal_api"]) for library in loaded]))
"""


def in_force(kernel: str | None = None) -> set[str]:
    """Return the kernels that a process has if one is forced, by default none.

    Raises
    ------
    RuntimeError
        If the process ends with an error, as where the processor lacks an instruction of the kernel.
    """
    run = subprocess.run(
        [sys.executable, "-c", _PROBE], env=environment(kernel), capture_output=True, text=True, check=False
    )
    if run.returncode:
        raise RuntimeError(f"a small computation {ending(run.returncode)}")
    return set(json.loads(run.stdout))


def environment(kernel: str | None) -> dict[str, str]:
    """Return the environment of a process of the tests with a kernel, or with the machine's own."""
    # The program, which a test may have started in this process, sets a safe path: the tests are modules of a folder.
    others = {name: value for name, value in os.environ.items() if name not in ("OPENBLAS_CORETYPE", "PYTHONSAFEPATH")}
    return others | ({"OPENBLAS_CORETYPE": kernel} if kernel else {})


def ending(status: int) -> str:
    """Return how a process ended, as the end of a sentence."""
    return f"is ended by {signal.Signals(-status).name}" if status < 0 else f"ends with status {status}"


def refusal(kernel: str) -> str:
    """Return why a kernel cannot be forced here, or an empty text."""
    try:
        loaded = in_force(kernel)
    except RuntimeError as error:
        return str(error)
    return "" if loaded == {kernel} else f"BLAS takes {', '.join(sorted(loaded))} in its place"


@dataclass(frozen=True, slots=True)
class Run:
    """The tests under one kernel with a number of threads."""

    kernel: str
    threads: int

    def passes(self, arguments: Sequence[str]) -> bool:
        """Run the tests with further arguments of pytest, and print the outcome."""
        print(f"\n== kernel {self.kernel}, threads: {self.threads}", flush=True)
        options = ["-m", LIGHT, f"--blas-threads={self.threads}"]
        command = [sys.executable, "-m", "pytest", *options, *TESTS, *arguments]
        status = subprocess.run(command, cwd=ROOT, env=environment(self.kernel), check=False).returncode
        print(f"kernel {self.kernel}, threads: {self.threads}: pytest {ending(status)}", flush=True)
        return status == 0


def planned(own: set[str], kernels: Sequence[str], every: bool) -> list[Run]:
    """Return the runs beside the one that the tests themselves are: the machine's own kernels with one thread.

    Examples
    --------
    >>> planned({"SkylakeX"}, ["Haswell", "SkylakeX"], every=False)
    [Run(kernel='Haswell', threads=1)]
    >>> [(run.kernel, run.threads) for run in planned({"SkylakeX"}, ["Haswell", "SkylakeX"], every=True)]
    [('Haswell', 1), ('Haswell', 2), ('SkylakeX', 2)]
    """
    runs = [Run(kernel, threads) for kernel in kernels for threads in (1, 2) if (own, threads) != ({kernel}, 1)]
    return runs if every else [run for run in runs if run.threads == 1][:1]


def main(arguments: list[str]) -> int:
    """Run the tests under other kernels; 0 if there are some that can be forced, and all tests pass."""
    parser = argparse.ArgumentParser(prog="python -m tests.blas.kernels", description=__doc__, allow_abbrev=False)
    parser.add_argument("--all", action="store_true", help="every kernel, with one thread and with two")
    args, of_pytest = parser.parse_known_args(arguments)
    refusals = {kernel: refusal(kernel) for kernel in KERNELS}
    for kernel, reason in refusals.items():
        if reason:
            print(f"kernel {kernel} is skipped: {reason}", flush=True)
    own = in_force()
    runs = planned(own, [kernel for kernel, reason in refusals.items() if not reason], args.all)
    failed = [run for run in runs if not run.passes(of_pytest)]
    print(f"own kernel: {', '.join(sorted(own))}; {len(runs) - len(failed)} of {len(runs)} runs under others pass")
    return 0 if runs and not failed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
