"""Landlock: writing in the scratch folder of a model, and nowhere else."""

import subprocess
import sys

import pytest

PROGRAM = """
import os, sys
from pathlib import Path
from comparisons.external.landlock import write_only_in

inside, elsewhere = map(Path, sys.argv[1:])
if not write_only_in(inside):
    print("not here")
    sys.exit()

def tried(action):
    try:
        action()
    except OSError as error:
        return type(error).__name__
    return "done"

print(
    tried(lambda: (inside / "new").write_text("x")),
    tried(lambda: Path(os.devnull).write_text("x")),
    tried(lambda: (elsewhere / "old").read_text()),
    tried(lambda: (elsewhere / "old").write_text("x")),
    tried(lambda: os.truncate(elsewhere / "old", 0)),
    tried(lambda: (elsewhere / "old").unlink()),
    tried(lambda: (elsewhere / "new").touch()),
    tried(lambda: (elsewhere / "folder").mkdir()),
    tried(lambda: os.rename(inside / "new", elsewhere / "new")),
)
"""


def test_only_the_scratch_folder_is_writable(tmp_path):
    inside, elsewhere = tmp_path / "inside", tmp_path / "elsewhere"
    inside.mkdir()
    elsewhere.mkdir()
    (elsewhere / "old").write_text("kept")
    command = [sys.executable, "-c", PROGRAM, str(inside), str(elsewhere)]
    outcomes = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    if outcomes == ["not", "here"]:
        pytest.skip("this kernel has no Landlock")
    assert outcomes[:3] == ["done"] * 3
    assert {outcomes[3], *outcomes[5:8]} == {"PermissionError"}
    # Truncation is refused from Linux 6.2 on, and a move across the border as such or as crossing devices.
    assert outcomes[4] in {"PermissionError", "done"}
    assert outcomes[8] in {"PermissionError", "OSError"}
    assert [path.name for path in elsewhere.iterdir()] == ["old"]
    assert (elsewhere / "old").read_text() in {"kept", ""}
