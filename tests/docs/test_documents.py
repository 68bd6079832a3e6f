"""The documents are true: examples run, links lead somewhere, every quantity has its symbol, formulas hold."""

import re
import shlex
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import mpmath
import pytest

import fscm
from comparisons.baseline import read_baseline
from comparisons.cli import main as cli
from comparisons.judging.gates import Gate, load_gates
from comparisons.judging.judge import judge
from comparisons.judging.selection import skipped_gates
from comparisons.judging.summary import summarise
from comparisons.quantities import QUANTITIES
from comparisons.runs.cases import grids, grids_for, load_grids
from comparisons.runs.tasks import plan
from fscm.physical import PhysicalProblem

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "docs" / "examples").glob("*.py"))
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]

#: What each example must print: the numbers the documents quote.
QUOTED = {
    "gecko_pad.py": ["Tabor number 2.6556", "27.066203 nN", "-1.34 %", "-0.74 %", "-1.23 %", "10.0064 aJ"],
    "own_shape_and_law.py": ["paraboloid    9-3   pull-off force 1.78848171", "rounded cone  10-4"],
    "own_modulus.py": ["27.06620 nN", "25.96980 nN", "25.69680 nN"],
    "errors_of_a_model.py": ["md-improved", "1.788482"],
}


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_an_example_runs_and_prints_what_is_quoted(path, tmp_path):
    done = subprocess.run([sys.executable, path], cwd=tmp_path, capture_output=True, text=True)
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
    code = blocks(ROOT / "README.md", "python")
    done = subprocess.run([sys.executable, "-c", "".join(code)], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    value, u_num = map(float, done.stdout.split())
    assert value == pytest.approx(1.78848171, abs=5e-9)
    assert 0.0 < u_num < 1e-9


def test_the_grid_of_the_front_page_is_one():
    (text,) = blocks(ROOT / "README.md", "toml")
    (grid,) = load_grids(text, tier="quick")
    assert len(grid.cases) == 12


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(path):
    links = re.findall(r"\]\(([^)#]+)\)", path.read_text(encoding="utf-8"))
    local = [link for link in links if "://" not in link]
    assert [link for link in local if not (path.parent / link).exists()] == []


def test_every_quantity_has_a_symbol():
    text = (ROOT / "docs" / "symbols.md").read_text(encoding="utf-8")
    assert [name for name in QUANTITIES if f"`{name}`" not in text] == []


def test_the_tabor_number_is_that_of_the_code():
    text = (ROOT / "docs" / "symbols.md").read_text(encoding="utf-8")
    formula = re.search(r"^    mu = (.*)$", text, flags=re.MULTILINE)[1].replace("^", "**")
    body = {"E0": 3e6, "c0": 2e-5, "nu": 0.3, "z0": 4e-10}
    for n, k, Q in ((2, 0, 1e-6), (2, 0.4, 1e-6), (1, 0.2, 0.5), (5, 0.6, 1e-24)):
        problem = PhysicalProblem(**body, n=n, k=k, Q=Q, work_of_adhesion=0.05)
        names = {"n": n, "k": k, "Q": Q, "c0": body["c0"], "z0": body["z0"], "dgamma": 0.05}
        mu = eval(formula, names | {"b": problem.response_factor, "Es": problem.contact_modulus})
        assert mu == pytest.approx(problem.tabor_number, rel=1e-12)
        if (n, k) == (2, 0):
            ordinary = (Q * 0.05**2 / (problem.contact_modulus**2 * body["z0"] ** 3)) ** (1 / 3)
            assert mu == pytest.approx(ordinary, rel=1e-12)


def test_the_gates_of_the_document_are_judged_as_it_says():
    text = (ROOT / "docs" / "judge_your_model.md").read_text(encoding="utf-8")
    example = re.search(r"```toml\n(\[\[gate\]\].*?)```", text, flags=re.DOTALL)[1]
    rows, curves = read_baseline(ROOT / "results" / "baseline")
    chosen = grids_for(grids("quick"), ["md-improved", "jkr"])
    asked = {task.key for task in plan(chosen, ["md-improved", "jkr"])}
    keys = rows[["model", "quantity", "n", "k", "mu"]].itertuples(index=False, name=None)
    rows = rows[[(*key, None) in asked for key in keys]]
    assert skipped_gates(load_gates(example), chosen, ["md-improved", "jkr"]) == []
    judged = summarise(judge(load_gates(example), chosen, rows, curves, ["md-improved", "jkr"]))
    assert judged[["gate", "candidate"]].to_numpy().tolist() == [
        ["SOFT-PARABOLOID", "md-improved"],
        ["SOFT-PARABOLOID", "jkr"],
        ["BETTER-THAN-JKR", "md-improved"],
    ]
    assert set(judged["verdict"]) == {"PASS"}
    with pytest.raises(ValueError, match=r"gate BETTER-THAN-JKR needs jkr, .*: add --model jkr"):
        skipped_gates(load_gates(example), chosen, ["md-improved"])


def test_every_key_of_a_gate_is_explained():
    text = (ROOT / "docs" / "judge_your_model.md").read_text(encoding="utf-8")
    table = text[text.index("| key | what it is |") :].partition("\n\n")[0]
    told = {name for line in table.splitlines() for name in re.findall(r"`(\w+)`", line.split("|")[1])}
    assert told == {field.name for field in fields(Gate)}


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
    assert float(fscm.ring_response(k, r, t)) == pytest.approx(float(t * integral / (2 * mpmath.pi)), rel=1e-13)


def test_what_a_cut_at_50_costs_a_cone():
    """Sec. 3 of the theory."""
    lost = mpmath.quad(lambda r: 16 / 3 * r * (r + 1) ** -3, [50, mpmath.inf])
    assert float(lost) == pytest.approx(0.10, abs=0.005)
    assert float(lost) / 2.880 == pytest.approx(0.036, abs=5e-4)
