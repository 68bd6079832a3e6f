"""Models made for tests: one of each kind of result, and a small grid to run them on."""

import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from copy import deepcopy
from functools import cache, wraps
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

import comparisons
from comparisons.cli.main import main
from comparisons.judging.gates import gates_text
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from comparisons.registry import MODELS
from comparisons.runs import environment, record
from comparisons.runs.cases import load_grids
from comparisons.runs.environment import code_digest as code
from comparisons.runs.folder_lock import locked
from tests.comparisons.grid_text import grid_text


class Toy:
    """A model with the value `value(problem)`; a value that is an exception is raised."""

    version = "7"
    citation = "none"
    domain = "tests"

    def __init__(self, name, value):
        self.name = name
        self._function = value

    def _value(self, problem):
        value = self._function(problem)
        if isinstance(value, BaseException):
            raise value
        return value

    def evaluate(self, problem, quantity):
        return Result(value=self._value(problem), u_num=1e-9, size=3, iterations=2, residual=1e-12)

    def curve(self, problem):
        self._value(problem)
        grid = np.linspace(-1.0, 1.0, 3)
        return Curve(displacement=grid, load=-grid, columns={"central_gap": -grid})


VALUES = {
    "exact": lambda problem: 2.0,
    "ten-percent": lambda problem: 2.2,
    "twelve-percent": lambda problem: 2.24,
    "absurd": lambda problem: 1e20 if problem.k == 0 else -1.7e308,
    "refuses": lambda problem: NotApplicable("it has no such [thing]"),
    "fails": lambda problem: ComputationFailed("100 iterations were not enough; start nearer"),
    "broken": lambda problem: ZeroDivisionError("float division by zero"),
    "picky": lambda problem: ValueError(
        f"k = {problem.k} is outside [0, 0.1]: the model is for nearly homogeneous solids"
    ),
    "nonsense": lambda problem: float("nan"),
}


def is_locked(folder):
    """Whether another thread, like another process, is kept from a folder."""

    def tried():
        with locked(folder):
            pass

    with ThreadPoolExecutor(1) as threads:
        return isinstance(threads.submit(tried).exception(), ValueError)


@pytest.fixture
def toys(monkeypatch):
    """Register the toy models for the length of a test."""
    module = ModuleType("toy_models")
    for name, value in VALUES.items():
        setattr(module, name.replace("-", "_"), lambda name=name, value=value: Toy(name, value))
        monkeypatch.setitem(MODELS, name, f"toy_models:{name.replace('-', '_')}")
    monkeypatch.setitem(sys.modules, "toy_models", module)
    return SimpleNamespace(names=list(VALUES))


#: Four cases.
GRID = grid_text(["ten-percent", "refuses"], "exact", id="toys", tier="quick", n=[2], k=[0, 0.4], mu=[0.1, 1])


GATES = """
[[gate]]
id = "TEN-PERCENT"
requirement = "The error is ten percent."
quantity = "pull_off_force"
candidate = "ten-percent"
reference = "exact"
cases = { mu = [0.1, 1] }
metric = "rel"
lower = 0.09
upper = 0.11
max_reference_uncertainty = 1e-6
basis = "derived"
grounds = "2.2 / 2."
min_cases = 4
tier = "quick"
"""


def with_entries(table, **entries):
    """A TOML table with some entries changed or added; a text that is no list and no table is quoted."""
    for name, value in entries.items():
        is_quoted = isinstance(value, str) and value[0] not in "[{"
        line = f"{name} = " + (f'"{value}"' if is_quoted else f"{value}") + "\n"
        changed = re.sub(rf"(?m)^{name} = .*\n", lambda _, line=line: line, table)
        table = changed if line in changed else f"{table}{line}"
    return table


@pytest.fixture(scope="session", autouse=True)
def code_read_once():
    """What a record has of code and machine is determined once: neither changes while the tests run.

    A test that gives the package another folder, or the functions of this module other results, has these.
    """
    running, code_digest = Path(comparisons.__file__).parents[1], cache(code)
    once = cache(environment.environment)

    def of_record():
        return deepcopy(once())

    @wraps(code)
    def code_of(root=None):
        return code_digest() if (root or environment._running_root()) == running else code(root)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(environment, "version", cache(environment.version))
        patch.setattr(environment, "code_digest", code_of)
        patch.setattr(record, "environment", of_record)
        yield


@pytest.fixture
def refused(capsys):
    """A function that gives the program arguments which it refuses in one sentence with some words; returns that."""

    def call(arguments, *words):
        capsys.readouterr()
        assert main([*map(str, arguments)]) == 2
        out, err = capsys.readouterr()
        assert (out, err.count("\n"), [word for word in words if word not in err]) == ("", 1, [])
        return err

    return call


@pytest.fixture
def small_grid(toys, monkeypatch):
    """Make `fscm-bench run` compute four cases of toy models and judge them by one gate."""
    monkeypatch.setattr("comparisons.pipeline.inputs.grids", lambda tier: load_grids(GRID))
    monkeypatch.setattr("comparisons.pipeline.inputs.gates_text", lambda path: gates_text(path) if path else GATES)
    return GATES


@pytest.fixture
def typeset(tmp_path):
    """A function that compiles tables, which fit A4; skips without pdflatex unless FSCM_BENCH_LATEX=required."""
    program = shutil.which("pdflatex")
    if program is None:
        packages = "texlive-latex-base texlive-latex-recommended texlive-science"
        reason = f"pdflatex is not installed (Debian: apt-get install {packages})"
        if os.environ.get("FSCM_BENCH_LATEX") == "required":
            pytest.fail(reason)
        pytest.skip(reason)

    def compiled(*tables, fits=True):
        head = r"\documentclass[a4paper]{article}\usepackage{array,booktabs,longtable,pdflscape,siunitx}"
        document = "\n".join([head, r"\begin{document}", *tables, r"\end{document}"])
        (tmp_path / "table.tex").write_text(document, encoding="utf-8")
        order = [program, "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "table.tex"]
        done = subprocess.run(order, cwd=tmp_path, capture_output=True, check=False, stdin=subprocess.DEVNULL)
        message = done.stdout.decode(errors="replace")
        assert done.returncode == 0, message[-2000:]
        log = (tmp_path / "table.log").read_text(errors="replace")
        assert "Missing character" not in log
        assert (tmp_path / "table.pdf").stat().st_size > 1000
        if fits:
            assert [over for over in re.findall(r"Overfull .hbox \((.*?)pt too wide\)", log) if float(over) > 1.0] == []
            assert "Overfull \\vbox" not in log
            assert "Float too large" not in log

    return compiled
