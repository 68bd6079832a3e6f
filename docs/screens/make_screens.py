"""Screens of the commands in a terminal of 60, 80 and 120 columns, made by tmux.

Run it with the Python of the environment in which fscm-bench is installed::

    python docs/screens/make_screens.py [NAME ...]

Each screen becomes docs/screens/NAME_COLUMNS.txt, in which ``$`` stands before the command.
"""

from __future__ import annotations

import shlex
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

__all__ = ["COLUMNS", "SCREENS", "captured"]

HERE = Path(__file__).resolve().parent

#: Widths of the terminals, and more lines than any screen has.
COLUMNS = (60, 80, 120)
_LINES = 1200

#: Name of a screen -> the command, which is called in a folder that has the results of the commands before.
SCREENS = {
    "help": "fscm-bench --help",
    "list_models": "fscm-bench list models",
    "list_quantities": "fscm-bench list quantities",
    "list_cases": "fscm-bench list cases",
    "list_gates": "fscm-bench list gates",
    "solve": "fscm-bench solve --model fscm --quantity pull_off_force --n 2 --k 0.4 --mu 1",
    "check_model": "fscm-bench check-model my-model/my_model.py:MyModel",
    "sweep": "fscm-bench sweep my_cases.toml --out sweep",
    "compare": "fscm-bench compare jkr dmt md-improved double-hertz-n-k --reference atlas --n 1 2 --k 0 0.4 --mu 0.1 1 "
    "--out compare",
    "run": "fscm-bench run --out run",
    "judge": "fscm-bench judge run",
    "judge_verbose": "fscm-bench judge run --verbose",
}

#: Commands whose screens are those of new folders; of a run, the wider screens resume the first.
_NEW_FOLDER = {"sweep", "compare"}

_CASES = """
[[grid]]
id = "sharp"
title = "Sharp punches on a graded solid"
reference = "md-improved"
models = ["jkr", "bradley", "dmt-strength", "carpick-ogletree-salmeron"]
quantities = ["pull_off_force", "jump_out_displacement"]
n = [1, 2]
k = [0, 0.4]
mu = [0.1, 1, 2]
"""

#: Seconds until a command that does not end is given up.
_MOST_SECONDS = 3600.0


def captured(command: str, columns: int, folder: Path) -> str:
    """Return what a command leaves on a terminal of so many columns.

    Parameters
    ----------
    command : str
    columns : int
    folder : Path
        Where it is called.
    """
    session = f"screen-{columns}-{time.monotonic_ns()}"
    end = folder / f"{session}.end"
    # The programs beside the Python of this process; COLUMNS of the caller would hide those of the terminal.
    path = f'PATH={shlex.quote(str(Path(sys.executable).parent))}:"$PATH"'
    program = f"unset COLUMNS LINES; {path} OPENBLAS_NUM_THREADS=1 {command}"
    script = f"{program}; touch {shlex.quote(str(end))}; sleep {_MOST_SECONDS}"
    tmux = ["tmux", "-L", session]  # a server of its own, without the settings of the user
    start = [
        *tmux,
        "-f",
        "/dev/null",
        "new-session",
        "-d",
        "-s",
        session,
        "-x",
        str(columns),
        "-y",
        str(_LINES),
        "-c",
        str(folder),
    ]
    subprocess.run([*start, f"bash -c {shlex.quote(script)}"], check=True)
    try:
        deadline = time.monotonic() + _MOST_SECONDS
        while not end.exists():
            if time.monotonic() > deadline:
                raise TimeoutError(f"{command} did not end in {_MOST_SECONDS:g} s")
            time.sleep(0.1)
        shown, before = "", "-"
        while shown != before:  # until tmux has read all that was written
            before = shown
            time.sleep(0.5)
            pane = [*tmux, "capture-pane", "-p", "-t", session]
            shown = subprocess.run(pane, check=True, capture_output=True, text=True).stdout
    finally:
        subprocess.run([*tmux, "kill-server"], check=False, capture_output=True)
        end.unlink(missing_ok=True)
    return "\n".join(line.rstrip() for line in shown.rstrip().splitlines())


def main(names: Sequence[str]) -> None:
    """Make these screens, or all."""
    if unknown := set(names) - set(SCREENS):
        sys.exit(f"no screen is called {', '.join(sorted(unknown))}; there are {', '.join(SCREENS)}")
    with TemporaryDirectory() as temporary:
        folder = Path(temporary)
        program = [str(Path(sys.executable).parent / "fscm-bench")]
        subprocess.run([*program, "new-model", "my-model"], check=True, cwd=folder, capture_output=True)
        (folder / "my_cases.toml").write_text(_CASES, encoding="utf-8")
        if names and "run" not in names and {"judge", "judge_verbose"} & set(names):
            subprocess.run([*program, "run", "--out", "run", "--quiet"], check=True, cwd=folder)
        for name in names or SCREENS:
            for columns in COLUMNS:
                command = SCREENS[name]
                shown = captured(f"{command}_{columns}" if name in _NEW_FOLDER else command, columns, folder)
                path = HERE / f"{name}_{columns}.txt"
                path.write_text(f"$ {command}\n{shown}\n", encoding="utf-8")
                print(path.name)


if __name__ == "__main__":
    main(sys.argv[1:])
