"""The gallery and the notebooks: every script draws, every notebook computes what is stored in it."""

import ast
import json
import re
from importlib import import_module
from pathlib import Path

import matplotlib as mpl
import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
SCRIPTS = sorted((DOCS / "gallery").glob("*.py"))
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))

#: A number below this is a bound, of which the size counts.
_BOUND = 1e-5


@pytest.fixture(autouse=True)
def no_window():
    with mpl.rc_context({"figure.max_open_warning": 0}):
        mpl.use("Agg")
        yield
        from matplotlib import pyplot

        pyplot.close("all")


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_of_the_gallery_draws(path, monkeypatch, tmp_path):
    from matplotlib import pyplot

    figures = []
    monkeypatch.setattr(pyplot, "show", lambda: figures.append(pyplot.gcf()))
    monkeypatch.chdir(tmp_path)
    text = path.read_text(encoding="utf-8")
    title, line, *_ = ast.get_docstring(ast.parse(text)).splitlines()
    assert line == "=" * len(title)
    exec(compile(text, str(path), "exec"), {"__name__": "__main__"})
    (figure,) = figures
    figure.draw_without_rendering()
    for axes in figure.axes:
        assert axes.has_data()
        # Not the axis of a colour bar, which has no label here.
        assert axes.get_xlabel() or axes.get_label() == "<colorbar>"
    assert list(tmp_path.iterdir()) == []


def numbers(cells):
    """The numbers that are stored in the cells, in order; a picture has none."""
    outputs = [output for cell in cells if cell["cell_type"] == "code" for output in cell["outputs"]]
    texts = [
        output["text"] if output["output_type"] == "stream" else output["data"].get("text/plain", "")
        for output in outputs
        if "image/svg+xml" not in output.get("data", {})
    ]
    return [float(number) for number in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e[-+]\d+)?", "\n".join(texts))]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_the_code_of_a_notebook_runs(path, monkeypatch, tmp_path):
    """In this process; the next test has its numbers.  The folder of its results is not in the repository."""
    monkeypatch.chdir(tmp_path)
    names = {}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            lines = "".join(cell["source"]).splitlines()
            exec("\n".join(line for line in lines if not line.startswith("%")), names)


@pytest.mark.heavy
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_computes_what_is_stored_in_it(path, tmp_path):
    """By Jupyter, which comes with the extra docs."""
    nbclient, nbformat = import_module("nbclient"), import_module("nbformat")
    stored, again = (nbformat.read(path, as_version=4) for _ in range(2))
    resources = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(again, timeout=1800, kernel_name="python3", resources=resources).execute()
    before, after = numbers(stored.cells), numbers(again.cells)
    assert len(before) == len(after) > 10
    for expected, computed in zip(before, after, strict=True):
        assert computed == pytest.approx(expected, rel=1e-6) or max(abs(expected), abs(computed)) < _BOUND
