"""Documents: examples, code blocks, commands, links and formulas."""

import io
import re
import shlex
from contextlib import chdir, redirect_stdout
from functools import cache
from types import SimpleNamespace

import pytest

import fem_reference
import fscm
from comparisons.cli import main as cli
from comparisons.judging.gates import load_gates
from comparisons.runs.cases import load_grids
from tests.paths import ROOT

DOCS = ROOT / "docs"
EXAMPLES = sorted((DOCS / "examples").glob("*.py"))
PROBLEMS = DOCS / "examples" / "problems"
DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted(DOCS.glob("*.md"))]
DOCUMENTS += sorted(DOCS.glob("decisions/*.md"))

#: Numbers that each example prints: those that the documents quote.
QUOTED = {
    "gecko_pad.py": ["Tabor number 2.6556", "27.066203 nN", "-1.34 %", "-0.74 %", "-1.23 %", "10.0064 aJ"],
    "own_shape_and_law.py": ["paraboloid    9-3   pull-off force 1.78848171", "rounded cone  10-4"],
    "own_modulus.py": ["27.06620 nN", "25.96979 nN", "25.69680 nN", "27.08988 nN"],
    "errors_of_a_model.py": ["md-improved", "1.788482"],
    "curve_fit_of_a_record.py": ["modulus (MPa)  800 +- "],
    "lmfit_model.py": ["modulus  3 +- ", "z0       0.4 +- 0"],
    "table_for_dem.py": ["overlap_m,force_on_approach_N,force_on_retreat_N,bound_N"],
    # The tables of docs/which_model.md, whose numbers are rounded to what any machine computes.
    "model_choice.py": [
        line
        for line in (DOCS / "which_model.md").read_text(encoding="utf-8").splitlines()
        if line.startswith(("| n |", "| 1 |", "| 1.5 |", "| 2 |", "| 3 |", "| 5 |"))
    ],
}


def blocks(path, language):
    """The code blocks of a document in a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", path.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


def printed_by(code, folder, path=None):
    """The lines that code prints in this process, in a folder; `path` is the file of the code, if it has one."""
    output = io.StringIO()
    with chdir(folder), redirect_stdout(output):
        exec(compile(code, "example", "exec"), {"__name__": "__main__", "__file__": str(path)})
    return output.getvalue().splitlines()


@pytest.fixture(scope="module", autouse=True)
def solved_once():
    """The examples and the tutorial share problems: each is solved once."""
    with pytest.MonkeyPatch.context() as patch:
        for package in (fscm, fem_reference):
            patch.setattr(package, "solve", cache(package.solve))
        yield


#: They take twenty seconds and more.
LONG = {"gecko_pad.py", "own_modulus.py", "model_choice.py"}

#: The pad in the units of the finite elements, and its pull-off force (N) with its bound, which a heavy test computes.
PAD = fem_reference.Problem(
    fem_reference.PowerLaw(E0=2e9, c0=1e-6, k=0.4, nu=0.3),
    fem_reference.PowerPunch(n=2, Q=100e-9),
    fem_reference.LennardJones(work_of_adhesion=0.05, z0=0.5e-9),
)
PAD_FORCE = SimpleNamespace(value=2.7066203164653405e-08, u_num=7.68e-15)


def solved_pad(problem, quantity, accuracy):
    """The stored force, of this problem alone."""
    assert (problem, quantity, accuracy) == (PAD, "pull_off_force", "quick")
    return PAD_FORCE


@pytest.mark.parametrize(
    "path", [pytest.param(path, marks=[pytest.mark.heavy] * (path.name in LONG), id=path.name) for path in EXAMPLES]
)
def test_an_example_runs_and_prints_the_quoted_numbers(path, tmp_path):
    printed = "\n".join(printed_by(path.read_text(encoding="utf-8"), tmp_path, path))
    assert [text for text in QUOTED[path.name] if text not in printed] == []


@pytest.mark.heavy
def test_the_stored_force_of_the_pad_is_that_of_the_finite_elements():
    computed = fem_reference.solve(PAD, "pull_off_force", accuracy="quick")
    assert abs(PAD_FORCE.value - computed.value) <= computed.u_num <= 1.5 * PAD_FORCE.u_num


@pytest.mark.parametrize("path", [ROOT / "README.md", DOCS / "getting_started.md"], ids=lambda path: path.name)
def test_the_python_of_a_first_page_prints_its_comments(path, tmp_path):
    code = "".join(blocks(path, "python"))
    printed = printed_by(code, tmp_path)
    stated = dict(re.findall(r"^print\((.*)\)  # (.*)$", code, flags=re.MULTILINE))
    assert "fscm, pull_off_force: " in stated["force"]
    assert stable(printed[0])[:34] == stable(stated["force"])[:34]
    # Of the first one the last digits of the bound differ from one processor to another.
    if len(printed) > 1:
        assert printed[-1] == [*stated.values()][-1]


def test_the_python_of_the_tutorial_prints_the_numbers_of_its_comments(tmp_path, monkeypatch):
    monkeypatch.setattr(fem_reference, "solve", solved_pad)
    code = "".join(blocks(DOCS / "tutorial.md", "python"))
    printed = [line for line in printed_by(code, tmp_path) if re.fullmatch(r"[-+.\de]+", line)]
    stated = re.findall(r"^print\(.*\)  # ([-+.\de]+)", code, flags=re.MULTILINE)
    assert len(printed) == len(stated) > 3
    for number, text in zip(printed, stated, strict=True):
        digits = len(text.partition("e")[0].replace(".", "").lstrip("-0"))
        assert f"{float(number):.{digits}g}" == f"{float(text):.{digits}g}"


def test_the_python_of_the_problem_files_prints_its_comments(tmp_path):
    (code,) = blocks(DOCS / "problem_files.md", "python")
    printed = printed_by(code, tmp_path)
    stated = re.findall(r"^print\(.*\)  # (.*)$", code, flags=re.MULTILINE)
    assert len(printed) == len(stated) == 2
    assert stable(printed[0])[:40] == stable(stated[0])[:40]
    assert float(printed[1]) == pytest.approx(float(stated[1]), rel=1e-4)


def test_every_command_parses():
    """Names of commands and options, choices, required arguments."""
    lines = [line for path in DOCUMENTS for block in blocks(path, "sh") for line in block.splitlines()]
    commands = [line for line in lines if line.startswith("fscm-bench ")]
    assert len(commands) > 50
    for line in commands:
        command, *_ = line.partition(" > ")  # the file that takes the output
        _, *arguments = shlex.split(command, comments=True)
        cli._parser(arguments).parse_args(arguments)


def test_every_grid_and_gate_of_a_document_loads():
    tables = [text for path in DOCUMENTS for text in blocks(path, "toml")]
    with_grids, with_gates = ([text for text in tables if f"[[{name}]]" in text] for name in ("grid", "gate"))
    assert with_grids
    assert with_gates
    for text in with_grids:
        assert all(grid.cases for grid in load_grids(text, tiers=None, folder=PROBLEMS))
    assert all(load_gates(text) for text in with_gates)


def anchors(path):
    """The anchors of the headings of a document, as on GitHub."""
    headings = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_links_and_names_of_modules_resolve():
    wrong = []
    for path in DOCUMENTS:
        text = path.read_text(encoding="utf-8")
        for link in re.findall(r"\]\(([^)\s]+)\)", text):
            name, _, anchor = link.partition("#")
            target = path.parent / name if name else path
            if "://" not in link and not (target.exists() and (not anchor or anchor in anchors(target))):
                wrong.append((path.name, link))
        names = re.findall(r"`((?:fscm|fem_reference|comparisons|tests)/[\w/]+\.\w+)`", text)
        wrong += [(path.name, name) for name in names if not (ROOT / name).exists()]
    assert wrong == []


#: What only Sphinx reads: directives as blocks and between colons, roles, targets and comments of MyST.
OF_SPHINX = re.compile(r"^ *(?:```+|~~~+|:::+) *\{|^:::|\{[\w:-]+\}`|^\([\w-]+\)=$|^% |^\+\+\+", re.MULTILINE)
#: The lists of pages, which a reader on GitHub has as folders.
HIDDEN = re.compile(r"^```\{toctree\}\n.*?^```", re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_a_page_is_readable_where_no_sphinx_is(path):
    text = path.read_text(encoding="utf-8")
    if path.name == "index.md":
        text, count = HIDDEN.subn("", text)
        assert count
    assert OF_SPHINX.findall(text) == []


@pytest.mark.parametrize("text", ["```{math}\nx\n```", ":::{note}\n", "see {ref}`a`", "(label)=\n", "% a comment\n"])
def test_what_only_sphinx_reads_is_detected(text):
    assert OF_SPHINX.search(text)


#: Tutorial of the coated pad: what it prints, its commands, and the force (nN) that the text states.
COATED_PAD = DOCS / "tutorial_coated_pad.md"
SHOWN = blocks(COATED_PAD, "text")
COMMANDS = [shlex.split(line)[1:] for block in blocks(COATED_PAD, "sh") for line in block.splitlines()]
FORCE = 138.242085


def stable(line):
    """A line without what differs between machines: the digits of a bound, and the time."""
    return re.sub(r"\(\d+(e-?\d+)?\)|\([\d.]+ s\)", "", line)


def test_the_file_of_the_coated_pad_is_that_of_the_examples():
    assert blocks(COATED_PAD, "toml") == [(PROBLEMS / "coated_pad.toml").read_text(encoding="utf-8")]
    assert [command[0] for command in COMMANDS] == ["describe", "solve", "curve"]
    assert [f"{FORCE}" in text for text in SHOWN[:2]] == [True, True]


@pytest.mark.heavy
def test_describe_prints_what_the_page_shows_without_the_uncertain_values(capsys):
    with chdir(PROBLEMS):
        assert cli.main([word for word in COMMANDS[0] if word != "--uncertain"]) == 0
    printed, on_page = capsys.readouterr().out.splitlines(), SHOWN[0].splitlines()
    assert [stable(line)[:60] for line in printed] == [stable(line)[:60] for line in on_page[: len(printed)]]
    assert printed[1].startswith(f"  pull-off force {FORCE}")
    assert on_page[len(printed)].startswith("uncertainty of pull_off_force")


@pytest.mark.heavy
def test_the_finite_elements_print_what_the_page_shows(capsys):
    with chdir(PROBLEMS):
        assert cli.main(COMMANDS[1]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert [stable(line) for line in printed] == [stable(line) for line in SHOWN[1].splitlines()]
    assert f"{FORCE}(" in printed[1]
