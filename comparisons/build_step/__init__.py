"""Build step of the distributions: the tables of the baseline in the wheel, and absolute links in the metadata.

`pyproject.toml` names the commands under ``[tool.setuptools.cmdclass]``.  They are not installed themselves.
"""

from __future__ import annotations

import re
from pathlib import Path

from setuptools.command.build_py import build_py
from setuptools.command.egg_info import egg_info

__all__ = ["TABLES", "BuildWithBaseline", "MetadataWithLinks", "absolute_links"]

#: Folder of the baseline in the repository, and in the wheel.
_SOURCE, _TARGET = Path("results", "baseline"), Path("comparisons", "data", "baseline")

#: What ``python -m comparisons.baseline --check`` and a reader of the numbers need.  The pictures, the nodes of the
#: atlas and the benchmark are in the source distribution only.
TABLES = ("*.csv", "paper/*.csv", "paper/*.md", "paper/*.tex")

#: A link or a picture of Markdown with a relative target.
_LINK = re.compile(r"(!?)\[([^\]]*)\]\((?![a-z]+:|#)([^)\s]+)\)")


class BuildWithBaseline(build_py):
    """The command of setuptools that copies the modules, and the tables of `results/baseline` too.

    An editable installation has no copy: it reads the tables in the clone.
    """

    def run(self) -> None:
        """Copy modules and tables."""
        super().run()
        for source, target in self._tables():
            self.mkpath(str(target.parent))
            self.copy_file(str(source), str(target), preserve_mode=False)

    def get_outputs(self, include_bytecode: bool = True) -> list[str]:
        """Return the files that the command makes."""
        return [*super().get_outputs(include_bytecode), *(str(target) for _, target in self._tables())]

    def _tables(self) -> list[tuple[Path, Path]]:
        if self.editable_mode:
            return []
        sources = [path for pattern in TABLES for path in sorted(_SOURCE.glob(pattern))]
        return [(path, Path(self.build_lib, _TARGET, path.relative_to(_SOURCE))) for path in sources]


class MetadataWithLinks(egg_info):
    """The command of setuptools that writes the metadata, with the README as it is shown elsewhere: on PyPI.

    Without an address of the repository ([project.urls], Source) the links stay relative.
    """

    def run(self) -> None:
        """Write the metadata."""
        metadata = self.distribution.metadata
        if source := metadata.project_urls.get("Source"):
            # Several commands of one build run this; the second finds nothing to change.
            metadata.long_description = absolute_links(metadata.long_description or "", source, f"v{metadata.version}")
        super().run()


def absolute_links(text: str, source: str, tag: str) -> str:
    """Return Markdown with absolute links in place of relative ones: into the repository, at the tag of a release.

    Examples
    --------
    >>> absolute_links("[a](docs/a.md#b), ![c](c.png), [d](#e)", "https://host/owner/name", "v1")
    '[a](https://host/owner/name/blob/v1/docs/a.md#b), ![c](https://host/owner/name/raw/v1/c.png), [d](#e)'
    """
    return _LINK.sub(
        lambda link: f"{link[1]}[{link[2]}]({source}/{'raw' if link[1] else 'blob'}/{tag}/{link[3]})", text
    )
