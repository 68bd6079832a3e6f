"""Imports between the packages and between the layers of `comparisons`."""

import ast
import re
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from tests.paths import ROOT

PACKAGES = ("fscm", "fem_reference", "comparisons")
#: Functions whose first argument is the name of a module.
BY_NAME = {"__import__", "files", "import_module", "importorskip", "_script"}

#: What a module may import of the other packages, by the start of its name; the longest start decides.
ALLOWED = {
    "fscm": (),
    "fem_reference": (),
    # The data of a problem, which every module of comparisons uses.
    "comparisons": ("fscm.problem", "fscm.punch", "fscm.laws", "fscm.solids"),
    # Shows what is inside the finite elements: fields, checks, solver table.
    "comparisons.cli.commands.fem": ("fem_reference", "fscm.problem", "fscm.punch", "fscm.laws"),
    # Shows the functions inside the FSCM.
    "comparisons.paper.figures.functions": ("fscm",),
    # The landing of a jump and the surface at pull-off are no quantities of a model; both jumps of one path, in half
    # the time of two computations.
    "comparisons.paper.tasks": ("fscm",),
    # Judges statements on the functions inside the FSCM and on the two Tabor numbers (Eqs. 18-22 and 30).
    "comparisons.paper.statements.formulas": ("fscm",),
    # Measures a solver at every accuracy, and the scheme of the paper beside it.
    "comparisons.bench.bead": ("fscm",),
    "comparisons.bench.work_precision": ("fscm", "fem_reference"),
    # Pose the problem of a file to each solver: any solid, punch and law.
    "comparisons.problem.problem": ("fscm",),
    # The pressure at the pull-off force and the surface compliance of a solid, which are no quantities of a model.
    "comparisons.problem.equivalent_solid": ("fscm",),
    # Checks the sections of a file before the whole.
    "comparisons.problem.reading": ("fscm",),
    # The equilibria under a machine, which are no quantity of a model.
    "comparisons.fitting.equilibria": ("fscm",),
    # The loads of a rigid ball by two interactions, which are no quantity of a model.
    "comparisons.description.strain_errors": ("fem_reference",),
    # Derivatives of a value, which are no quantity of a model.
    "comparisons.description.uncertainty": ("fscm",),
    # The Stieltjes scheme from an accurate surface on.
    "comparisons.paper.scheme_forces": ("fscm",),
    # Only the adapters know the solvers.
    "comparisons.models.atlas": ("fscm",),
    "comparisons.models.fscm_model": ("fscm",),
    "comparisons.models.gibson_limit": ("fscm",),
    "comparisons.models.fem_model": ("fem_reference", "fscm.problem", "fscm.punch", "fscm.laws"),
}

#: First layer to last: the modules and folders of each package.  A module imports from its own layer and those before.
LAYERS = {
    "fscm": (
        (
            "errors",
            "_typing",
            "_threads",
            "_validation",
            "_presentation",
            "_numbers",
            "_response_factor",
            "_law_curve",
            "_roots",
        ),
        ("laws", "tabulated_law", "cohesive_laws", "dlvo", "wells", "punch", "custom_punch", "measured_punch"),
        ("_whole_punch", "_chebyshev_tree", "_potential", "_potential_table"),
        ("_ball_under_law", "_ball", "_body_of_revolution", "_curved_face", "interaction"),
        ("solids", "layers", "tabulated_modulus", "custom_solid"),
        ("bodies", "_units", "_problem_checks"),
        ("accuracy",),
        ("problem",),
        ("_surface",),
        ("_path",),
        ("solution",),
        ("_bound",),
        ("folds", "stability", "critical", "quantities"),
        ("interpolation", "_many"),
        ("_known_minimum",),
        ("analysis", "path"),
        ("gibson", "stieltjes"),
        ("experiment", "states", "solver", "_sensitivity"),
        ("many",),
    ),
    "fem_reference": (
        ("_typing", "_threads", "_validation", "_presentation", "_numbers", "errors", "_roots", "_law_between_points"),
        ("solid", "solids", "tabulated_modulus", "custom_solid", "neo_hookean"),
        ("punch", "profiles", "laws", "_wells", "tabulated_law", "cohesive_laws", "dlvo"),
        (
            "_azimuth",
            "_face",
            "_vertical_line",
            "_surface_force",
            "_ball_under_law",
            "_curved_face",
            "_body_of_revolution",
        ),
        ("interaction", "problem", "accuracy"),
        ("_elastic",),
        ("_linear",),
        ("_contact",),
        ("_large_strain",),
        ("quantities", "result", "solution", "states", "large_strain", "export"),
        ("verification",),
    ),
    "comparisons": (
        ("console", "data", "numerics"),
        ("model", "quantities", "domain", "problem"),
        ("models", "external"),
        ("registry",),
        ("runs",),
        ("description",),
        ("judging",),
        ("output",),
        ("fitting",),
        ("paper",),
        ("pipeline",),
        ("bench",),
        ("baseline",),
        ("cli", "pytest_entry"),
        ("__main__",),
        ("start_entry",),
    ),
}


def dotted(path: Path) -> str:
    """The name of the module in a file."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def modules() -> dict[str, Path]:
    """Every module of the three packages, by dotted name."""
    return {dotted(path): path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))}


@cache
def imports_of(path: Path) -> set[str]:
    """Every module that a file imports."""
    return imported(dotted(path), path.read_text(encoding="utf-8"), path.name == "__init__.py")


def imported(name: str, source: str, is_package: bool = False) -> set[str]:
    """Every module that `source` imports, also inside functions, relatively, or by a call such as `files("...")`."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = name.split(".")[: (1 if is_package else 0) - node.level or None]
                base = ".".join([*above, *filter(None, [node.module])])
            names |= {base} | {f"{base}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Call) and called(node.func) in BY_NAME:
            names |= {str(argument.value) for argument in node.args[:1] if isinstance(argument, ast.Constant)}
    return names


def called(function: ast.expr) -> str:
    """The last name of what is called."""
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


@cache
def within(name: str, starts: tuple[str, ...]) -> bool:
    return any(name == start or name.startswith(f"{start}.") for start in starts)


@cache
def ours(name: str, path: Path) -> set[str]:
    """The modules of the three packages that a module imports (not the names in them)."""
    all_modules = modules()
    return {module for module in imports_of(path) if module in all_modules and module != name}


def test_packages_import_only_what_they_may():
    wrong = []
    for name, path in modules().items():
        rule = ALLOWED[max((start for start in ALLOWED if within(name, (start,))), key=len)]
        of_others = {module for module in ours(name, path) if module.split(".")[0] != name.split(".")[0]}
        # "from fscm.problem import ..." also names the package itself.
        wrong += [(name, module) for module in of_others if "." in module and not within(module, rule)]
        if not any("." not in allowed for allowed in rule):
            bare = imports_of(path) & {*PACKAGES} - {name.split(".")[0]}
            wrong += [(name, package) for package in bare]
    assert wrong == []


def layer(name: str) -> int:
    """Index of the layer of a module in its package."""
    package, top = name.split(".")[:2]
    return next(index for index, names in enumerate(LAYERS[package]) if top in names)


def test_a_module_imports_from_its_own_layer_or_those_before_it():
    wrong = []
    for name, path in modules().items():
        siblings = [module for module in ours(name, path) if module.startswith(name.split(".")[0] + ".")]
        wrong += [(name, module) for module in siblings if "." in name and layer(module) > layer(name)]
    assert wrong == []


#: Rooms of the integral equation, and what each may import of them: a state, the path of states, their bounds.
ROOMS = {"fscm._surface": (), "fscm._path": ("fscm._surface",), "fscm._bound": ("fscm._surface", "fscm._path")}


@pytest.mark.parametrize("room", ROOMS)
def test_rooms_import_one_way(room):
    wrong = [
        (name, module)
        for name, path in modules().items()
        if within(name, (room,))
        for module in ours(name, path)
        if within(module, tuple(ROOMS)) and not within(module, (room, *ROOMS[room]))
    ]
    assert wrong == []


@pytest.mark.parametrize("package", ["fscm", "fem_reference"])
def test_no_module_imports_itself_by_others(package):
    """Imports for type checking count: a circle is one whether it runs or not."""
    graph = {name: ours(name, path) for name, path in modules().items() if within(name, (package,))}
    order = tuple(TopologicalSorter(graph).static_order())
    assert {*graph} <= {*order}


def test_a_circle_is_seen():
    with pytest.raises(CycleError):
        tuple(TopologicalSorter({"fscm.a": {"fscm.b"}, "fscm.b": {"fscm.a"}}).static_order())


@pytest.mark.parametrize("package", ["fscm", "fem_reference"])
def test_the_modules_that_a_solver_numbers_exist(package):
    text = ast.get_docstring(ast.parse(modules()[package].read_text(encoding="utf-8")))
    named = re.findall(r"`((?:_\w+\.)?\w+)`", text.split("What a solver")[1].split("The names")[0])
    assert len(named) > 15
    assert {f"{package}.{name}" for name in named} - {*modules()} == set()


@pytest.mark.parametrize("package", PACKAGES)
def test_every_name_of_the_layers_exists(package):
    listed = [name for names in LAYERS[package] for name in names]
    assert sorted(listed) == sorted({name.split(".")[1] for name in modules() if name.startswith(f"{package}.")})


def test_the_solver_does_not_load_the_verification():
    assert not any("verification" in module for module in ours("fem_reference", modules()["fem_reference"]))


@pytest.mark.parametrize("name", ["fscm/ring_code", "fem_reference/hankel_reference", "solvers/layered_jkr"])
def test_a_code_of_the_tests_that_is_a_reference_imports_nothing_of_the_packages(name):
    imports = imports_of(ROOT / "tests" / f"{name}.py")
    assert {module.partition(".")[0] for module in imports} & {*PACKAGES, "tests"} == set()


def test_every_way_to_import_is_seen():
    for source in (
        "import fem_reference.mesh",
        "from fem_reference.mesh import build",
        "def f():\n    from fem_reference import mesh",
        "import importlib\nimportlib.import_module('fem_reference.mesh')",
        "from ..fem_reference import mesh",
    ):
        assert any(module.startswith("fem_reference") for module in imported("fscm.kernel", source))
