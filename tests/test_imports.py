"""Libraries that a fit and the imports of the packages do not load: they would be most of the time."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

_EXAMPLES = ROOT / "docs" / "examples"
_ARGUMENTS = [
    "fit",
    str(_EXAMPLES / "measured_curve.csv"),
    "--problem",
    str(_EXAMPLES / "problems" / "probe.toml"),
    "--free",
    "solid.E",
    "law.work_of_adhesion",
]
_FIT = f"from comparisons.cli.main import main; main({_ARGUMENTS})"

_ELEMENTS = (
    "from fem_reference import Homogeneous, LennardJones, PowerPunch, Problem, solve; "
    "body = Problem(Homogeneous(50.0, 0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)); "
    "solve(body, 'pull_off_force', 'quick')"
)

#: Large libraries of tables, pictures and units.  A module that loads pandas with its first use has its name from the
#: beginning, not its parts.
_LARGE = {"pandas.core", "matplotlib", "pint", "jsonschema", "scipy.stats"}


def loaded(code):
    """The modules that a new interpreter has loaded after a piece of code."""
    ended = subprocess.run(
        [sys.executable, "-c", f"import sys, json; {code}; print(json.dumps([*sys.modules]), file=sys.stderr)"],
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
    )
    return {*json.loads(ended.stderr.splitlines()[-1])}


@pytest.mark.parametrize(
    ("code", "unused"),
    [
        (
            _FIT,
            _LARGE | {"lmfit", "scipy.interpolate", "mpmath", "fscm.analysis", "skfem"},
        ),
        ("import fscm", _LARGE | {"scipy.linalg", "scipy.optimize", "scipy.interpolate", "fscm.analysis", "mpmath"}),
        ("import fscm; fscm.force_curve(2, 0, 1)", _LARGE | {"scipy.linalg", "scipy.optimize", "scipy.interpolate"}),
        (
            "import fscm; fscm.solve(fscm.Problem(n=2, k=0.4, mu=1), 'pull_off_force')",
            _LARGE | {"scipy", "mpmath", "numpy.ma", "numpy.testing", "hashlib", "fscm.tabulated_law", "fscm.gibson"},
        ),
        (
            "import fscm; solid = fscm.Coating(1.0, 9.0, 1.0, 0.1, 0.3);"
            "from fscm._surface.response import response_of; response_of(solid).at_center(1e3, by_waves=True)",
            _LARGE | {"scipy.optimize", "scipy.interpolate", "scipy.sparse"},
        ),
        (
            "import fem_reference",
            _LARGE | {"scipy.linalg", "scipy.optimize", "scipy.interpolate", "skfem", "pyamg", "mpmath"},
        ),
        (_ELEMENTS, _LARGE | {"scipy.optimize", "scipy.interpolate", "scipy.special", "mpmath"}),
    ],
    ids=["fit", "fscm", "force_curve", "fscm.solve", "coating", "fem_reference", "elements"],
)
def test_what_is_not_used_is_not_loaded(code, unused):
    assert not unused & loaded(code)
