"""The documents are true: examples run, links lead somewhere, every quantity has its symbol, formulas hold."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import mpmath
import pytest

from comparisons import cli
from comparisons.quantities import QUANTITIES
from fscm import kernel

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "docs" / "examples").glob("*.py"))
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]

#: What each example must print: the numbers the documents quote.
QUOTED = {
    "gecko_pad.py": ["Tabor number 2.6556", "27.066203 nN", "-1.34 %", "-0.74 %", "-1.23 %", "10.0064 aJ"],
    "own_shape_and_law.py": ["paraboloid    9-3   pull-off force 1.78848171", "rounded cone  10-4"],
    "errors_of_a_model.py": ["md-improved", "1.788482"],
}


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_an_example_runs_and_prints_what_is_quoted(path, tmp_path):
    done = subprocess.run([sys.executable, path], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert QUOTED[path.name]
    assert [text for text in QUOTED[path.name] if text not in done.stdout] == []


def test_the_tutorial_quotes_its_example():
    text = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
    assert [number for number in ("2.6556", "27.066203", "-1.34 %", "-0.74 %", "-1.23 %") if number not in text] == []
    code = (ROOT / "docs" / "examples" / "gecko_pad.py").read_text(encoding="utf-8")
    for name, value in re.findall(r"^    (\w+)=([\d.e-]+),", text, flags=re.MULTILINE):
        assert f"{name}={value}," in code


def blocks(path, language):
    """The code blocks of a document in a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", path.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


COMMANDS = [line for path in DOCUMENTS for block in blocks(path, "sh") for line in block.splitlines()]


@pytest.mark.parametrize("line", [line for line in COMMANDS if line.startswith("fscm-bench ")])
def test_a_command_people_are_told_to_type_is_one(line):
    """It parses: names of commands and options, choices, what is required."""
    _, *arguments = shlex.split(line, comments=True)
    cli._parser().parse_args(cli._keep_negative_numbers(arguments))


def test_commands_are_found():
    assert len([line for line in COMMANDS if line.startswith("fscm-bench ")]) > 20


def test_the_python_of_the_front_page_runs(tmp_path):
    (code,) = blocks(ROOT / "README.md", "python")
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    value, u_num = map(float, done.stdout.split())
    assert value == pytest.approx(1.78848171, abs=5e-9)
    assert 0.0 < u_num < 1e-9


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(path):
    links = re.findall(r"\]\(([^)#]+)\)", path.read_text(encoding="utf-8"))
    local = [link for link in links if "://" not in link]
    assert [link for link in local if not (path.parent / link).exists()] == []


def test_every_quantity_has_a_symbol():
    text = (ROOT / "docs" / "symbols.md").read_text(encoding="utf-8")
    assert [name for name in QUANTITIES if f"`{name}`" not in text] == []


def test_every_module_named_in_the_theory_exists():
    text = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    for heading in re.findall(r"^## .*$|^\* \*\*.*$", text, flags=re.MULTILINE):
        folder = None
        for name in re.findall(r"`([\w/]+\.py)`", heading):
            folder = name.rpartition("/")[0] or folder
            assert (ROOT / folder / name.rpartition("/")[2]).exists(), name


@pytest.mark.parametrize("k", [0.0, 0.3, 0.7])
def test_the_ring_response_is_the_integral_of_point_forces(k):
    """Sec. 1 of the theory, by quadrature over the ring."""
    r, t = 0.7, 1.6
    integral = mpmath.quad(
        lambda phi: (r * r + t * t - 2 * r * t * mpmath.cos(phi)) ** (-(1 + k) / 2), [0, mpmath.pi, 2 * mpmath.pi]
    )
    assert float(kernel.ring_response(k, r, t)) == pytest.approx(float(t * integral / (2 * mpmath.pi)), rel=1e-13)


def test_what_a_cut_at_50_costs_a_cone():
    """Sec. 3 of the theory."""
    lost = mpmath.quad(lambda r: 16 / 3 * r * (r + 1) ** -3, [50, mpmath.inf])
    assert float(lost) == pytest.approx(0.10, abs=0.005)
    assert float(lost) / 2.880 == pytest.approx(0.036, abs=5e-4)
