"""Constraints for pip: the lowest version of every dependency that pyproject.toml admits.

python .github/constraints/lowest.py > lowest.txt
python -m pip install -c lowest.txt '.[test]'
"""

import re
import tomllib
from pathlib import Path

PROJECT = tomllib.loads((Path(__file__).resolve().parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]

#: Requirements of dependencies, which have no upper bound for them: newer ones warn about the lowest versions.
OF_DEPENDENCIES = {
    # Matplotlib 3.9 calls functions that pyparsing 3.3 deprecates.
    "pyparsing": "3.1.0",
}


def constraints() -> list[str]:
    """Return one line for each dependency, of the packages and of the extras that the tests need."""
    needed = PROJECT["dependencies"] + PROJECT["optional-dependencies"]["test"]
    lowest = dict(re.fullmatch(r"([\w.-]+)>=([\w.]+)", line).groups() for line in needed)
    return [f"{name}=={version}" for name, version in sorted((lowest | OF_DEPENDENCIES).items())]


if __name__ == "__main__":
    print("\n".join(constraints()))
