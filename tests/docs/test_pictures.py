"""The picture of the front pages: its points are values of the solver, and its files are those of the script."""

import json
import re
from importlib import util
from pathlib import Path

import pytest
from PIL import Image

import fscm

ROOT = Path(__file__).resolve().parents[2]
FILES = ROOT / "docs" / "_static"
PAGES = (ROOT / "README.md", ROOT / "docs" / "index.md", ROOT / "docs" / "symbols.md")


@pytest.fixture(scope="module")
def contact():
    """The script, which is in no package."""
    spec = util.spec_from_file_location("contact_picture", ROOT / "docs" / "pictures" / "contact.py")
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def path(contact):
    return fscm.trace(contact.PROBLEM, "quick", max_load=1.3, with_bounds=False)


def test_the_named_points_are_values_of_the_solver(contact, path):
    points = contact.points(path)
    assert points.keys() == contact.EVENTS.keys()
    force = fscm.solve(contact.PROBLEM, "pull_off_force", "quick").value
    assert points["pull_off"][1] == pytest.approx(-force, abs=1e-3)
    for event in points:
        displacement = fscm.solve(contact.PROBLEM, f"{event}_displacement", "quick").value
        assert points[event][0] == pytest.approx(displacement, abs=5e-3)


@pytest.mark.parametrize("file", sorted(FILES.glob("contact-*")), ids=lambda file: file.name)
def test_a_file_is_of_this_script_and_states_the_points_of_this_solver(file, contact, path):
    """After a change of the script: python docs/pictures/contact.py."""
    with Image.open(file) as picture:
        stated = picture.text
    assert stated["Script"] == contact.checksum()
    drawn, computed = json.loads(stated["Points"]), contact.points(path)
    assert drawn.keys() == computed.keys()
    for event, point in computed.items():
        assert drawn[event] == pytest.approx(point, abs=1e-6)


def test_the_script_draws_the_files(contact, path, monkeypatch, tmp_path):
    """One of them here."""
    assert {f"contact-{layout}-{theme}.png" for layout in contact.LAYOUTS for theme in contact.THEMES} == {
        file.name for file in FILES.glob("contact-*")
    }
    monkeypatch.setattr(fscm, "trace", lambda *_, **__: path)
    monkeypatch.setattr(contact, "LAYOUTS", {"wide": contact.LAYOUTS["wide"]})
    monkeypatch.setattr(contact, "THEMES", {"dark": contact.THEMES["dark"]})
    contact.write(tmp_path)
    (file,) = tmp_path.iterdir()
    with Image.open(file) as drawn, Image.open(FILES / file.name) as stored:
        assert (file.name, drawn.size) == ("contact-wide-dark.png", stored.size)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_page_shows_every_variant_and_says_what_it_shows(page):
    (picture,) = re.findall(r"<picture>.*?</picture>", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    shown = re.findall(r'(?:srcset|src)="([^"]+)"', picture)
    assert sorted(Path(name).name for name in shown) == sorted(file.name for file in FILES.glob("contact-*"))
    assert [name for name in shown if not (page.parent / name).exists()] == []
    assert len(re.search(r'alt="([^"]+)"', picture)[1]) > 50
