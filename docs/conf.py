"""Settings of the documentation site: ``sphinx-build -nW --keep-going docs build/site``, which needs no network."""

import sys
from importlib.metadata import version as installed_version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_extensions"))

project = "fscm-bench"
author = copyright = "The fscm-bench developers"
version = release = installed_version("fscm-bench")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
    "accessible",
    "mathml",
    "api_pages",
    "repository_pages",
]
exclude_patterns = [
    *("_extensions", "examples", "ci", "gallery", "pictures", "**/.ipynb_checkpoints"),
    *("_generated/gallery/*.ipynb", "**/sg_execution_times.rst"),
]
nitpicky = True
nitpick_ignore_regex = [("py:class", r"collections\.abc\..*")]  # the inventory of Python needs a network
html_theme = "furo"
html_title = "fscm-bench"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_show_sourcelink = False
html_copy_source = False
templates_path: list[str] = []

# Markdown as on GitHub: formulas between dollar signs, and anchors of headings.
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
nb_execution_mode = "off"  # the notebooks are stored with their output, and the tests execute them

autodoc_typehints = "none"  # the docstrings have the types
autodoc_member_order = "bysource"
default_role = "code"
numpydoc_show_class_members = False
numpydoc_xref_param_type = False

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "_generated/gallery",
    "filename_pattern": "",
    "ignore_pattern": "__init__",
    "download_all_examples": False,
    "show_signature": False,
    "min_reported_time": 1e9,
    "reference_url": {},
    "abort_on_example_error": True,
    "remove_config_comments": True,
    "write_computation_times": False,
    "within_subsection_order": "FileNameSortKey",
}
