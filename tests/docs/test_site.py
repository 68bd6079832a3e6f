"""The documentation site: every public name, every page in a table of contents, spelling, and the whole site."""

import re
import runpy
import subprocess
import sys
from importlib import import_module, util
from inspect import getmembers, isclass, isfunction
from pkgutil import walk_packages

import pytest

import comparisons
import fem_reference
import fscm
from comparisons.problem.kinds import KINDS, SECTIONS
from comparisons.runs.environment import NOT_INSTALLED
from tests.paths import ROOT

DOCS = ROOT / "docs"
PACKAGES = ("fscm", "fem_reference", "comparisons")


def extension(name):
    """A module of `docs/_extensions`, which is no package: its modules import each other by their names."""
    spec = util.spec_from_file_location(f"docs_{name}", DOCS / "_extensions" / f"{name}.py")
    module = util.module_from_spec(spec)
    sys.path.insert(0, str(DOCS / "_extensions"))
    try:
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(DOCS / "_extensions"))
    return module


@pytest.fixture(scope="module")
def api():
    return extension("api_pages")


@pytest.fixture(scope="module")
def reference(api):
    """The pages of the API reference: name -> text."""
    return dict(api.pages())


def documented(reference):
    """What the directives of the reference describe."""
    return set(re.findall(r"^\.\. (?:auto(?:class|function)|py:data):: (\S+)$", "\n".join(reference.values()), re.M))


def is_private(name):
    return "._" in name


def public(package):
    """Public modules, found by importing the packages; without commands and those that are not installed."""
    left_out = ("comparisons.cli.commands", *(".".join(folder.parts) for folder in NOT_INSTALLED))
    names = [module.name for module in walk_packages(package.__path__, f"{package.__name__}.")]
    return [import_module(name) for name in names if not name.startswith(left_out) and not is_private(name)]


def names_of(module):
    """What a module states; if it states nothing, its functions and classes with a text."""
    defined = getmembers(module, lambda value: isfunction(value) or isclass(value))
    own = [(name, value) for name, value in defined if value.__module__ == module.__name__ and value.__doc__]
    return getattr(module, "__all__", [name for name, _ in own if not name.startswith("_")])


@pytest.mark.parametrize("package", [fscm, fem_reference, comparisons], ids=lambda package: package.__name__)
def test_the_reference_has_every_name_of_a_package_and_of_its_public_modules(package, reference):
    described = documented(reference)
    names_of_package = {f"{package.__name__}.{name}" for name in package.__all__}
    objects = {id(getattr(package, name)) for name in package.__all__}
    names_of_modules = {
        f"{module.__name__}.{name}"
        for module in public(package)
        for name in names_of(module)
        if id(getattr(module, name)) not in objects
    }
    assert (names_of_package | names_of_modules) - described == set()
    assert [name for name in described if is_private(name)] == []


@pytest.mark.parametrize("package", [fscm, fem_reference, comparisons], ids=lambda package: package.__name__)
def test_no_public_attribute_of_a_class_is_a_private_class(package):
    """The reference writes "alias of" such an attribute, with a link that leads nowhere."""
    classes = {value for module in public(package) for _, value in getmembers(module, isclass)}
    own = [value for value in classes if value.__module__.startswith(package.__name__)]
    assert own
    attributes = [(cls, name, value) for cls in own for name, value in vars(cls).items() if not name.startswith("_")]
    assert [(cls, name) for cls, name, value in attributes if isclass(value) and value.__name__.startswith("_")] == []


def test_the_first_page_of_the_reference_has_names_that_it_describes(reference):
    names = [name for group in extension("api_start").NAMES.values() for name in group]
    assert len(names) == len(set(names)) == 26
    assert [name for name in names if name not in documented(reference)] == []
    assert [name for name in names if f":py:obj:`{name}`" not in reference["index"]] == []
    # The text says so of the classes of the FSCM.
    solids_punches_laws = [
        group for purpose, group in extension("api_start").NAMES.items() if purpose in "Solids Punches Laws"
    ]
    classes = [name.removeprefix("fscm.") for group in solids_punches_laws for name in group]
    assert len(classes) == 13
    assert [name for name in classes if name not in fem_reference.__all__] == []


def test_the_page_of_problem_files_has_a_table_of_every_kind():
    text = (DOCS / "problem_files.md").read_text(encoding="utf-8")
    assert runpy.run_path(DOCS / "kind_tables.py")["with_tables"](text) == text
    for section in SECTIONS:
        kinds = KINDS[section]
        rows = text.partition(f"## [{section}]")[2].partition("\n## ")[0].splitlines()
        assert [name for name in kinds if sum(row.startswith(f"| `{name}` |") for row in rows) != 1] == []


@pytest.mark.lint
def test_spelling():
    """The documents, the names of files aside; words of the trade are in `[tool.codespell]` of pyproject.toml."""
    names = [*ROOT.glob("*.md"), ROOT / "CITATION.cff", *(ROOT / name for name in ("docs", *PACKAGES))]
    command = [sys.executable, "-m", "codespell_lib", *names]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert (done.stdout, done.returncode) == ("", 0)


@pytest.mark.heavy
def test_the_site_builds_without_a_warning_and_needs_no_network(tmp_path):
    """All references resolve (-n), warnings are errors (-W), and no page loads anything from elsewhere."""
    if util.find_spec("sphinx") is None:
        pytest.skip("the extra docs is not installed")
    site = tmp_path / "site"
    command = [sys.executable, "-m", "sphinx", "-nW", "--keep-going", "-q", "-d", tmp_path / "doctrees", DOCS, site]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-4000:]
    pages = {path.relative_to(site).as_posix(): path.read_text(encoding="utf-8") for path in site.rglob("*.html")}
    assert {"index.html", "search.html", "theory.html", "_generated/api/fscm.html"} <= pages.keys()
    assert "<math" in pages["theory.html"]
    # A heading without a level is no heading for a screen reader.
    heading = re.compile(r'role="heading"(?! aria-level="\d")')
    assert [name for name, text in pages.items() if heading.search(text)] == []
    loaded = re.compile(r"<(?:script|img|iframe)[^>]*src=\"(?:https?:)?//|<link[^>]*href=\"(?:https?:)?//")
    assert [name for name, text in pages.items() if loaded.search(text)] == []
    assert (site / "searchindex.js").stat().st_size > 100_000
