"""Places of this repository."""

from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
#: Problem files of the documentation, and the one of them that is a power law.
PROBLEMS = ROOT / "docs" / "examples" / "problems"
PAD = PROBLEMS / "graded_pad.toml"
