"""Problem of a file as data: the sections in SI, and the tables that they name."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

from comparisons.problem_file.kinds import SECTIONS, kind_of
from comparisons.problem_file.uncertain import Uncertainty

__all__ = ["ProblemFile", "Section"]


@dataclass(frozen=True)
class Section:
    """One section of a problem file.

    Attributes
    ----------
    kind : str
    values : mapping of str to float, tuple of float or str
        Numbers in SI, lists of them, and the name of the file of a table.
    columns : mapping of str to tuple of float
        The columns of that file, in SI.
    uncertain : mapping of str to Uncertainty
        Of the values that have a standard deviation or an interval.

    Examples
    --------
    >>> Section("sphere", {"R": 1e-6})["R"]
    1e-06
    """

    kind: str
    values: Mapping[str, Any]
    columns: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    uncertain: Mapping[str, Uncertainty] = field(default_factory=dict)

    def __getitem__(self, key: str) -> Any:
        return self.values[key]

    def get(self, key: str, default: Any = None) -> Any:
        """Return a value, or the default where the file does not have it."""
        return self.values.get(key, default)

    def changed(self, key: str, value: float) -> Section:
        """Return the section with another value of a key.

        Examples
        --------
        >>> Section("sphere", {"R": 1e-6}).changed("R", 2e-6)["R"]
        2e-06
        """
        return replace(self, values={**self.values, key: value})

    @property
    def parameters(self) -> dict[str, Any]:
        """The kind and the values, for output."""
        return {"kind": self.kind, **self.values}


@dataclass(frozen=True)
class ProblemFile:
    """A problem in SI units.

    Attributes
    ----------
    path : Path
        The file that was read.
    solid, punch, law : Section

    Examples
    --------
    >>> solid = Section("power-law", {"E0": 1e9, "c0": 1e-7, "k": 0.0, "nu": 0.3})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
    >>> ProblemFile(Path("pad.toml"), solid, Section("sphere", {"R": 1e-6}), law).is_of_the_paper
    True
    """

    path: Path
    solid: Section
    punch: Section
    law: Section

    def __hash__(self) -> int:
        return hash(self.digest)

    @property
    def parameters(self) -> dict[str, Any]:
        """The content for output: the name of the file and the three sections."""
        sections = {name: getattr(self, name).parameters for name in SECTIONS}
        return {"file": self.path.name, **sections}

    @property
    def power_law(self) -> Section | None:
        """The solid as E0 (z/c0)^k, also if it is homogeneous; None if it is another one."""
        values_of = kind_of("solid", self.solid.kind).power_law
        return None if values_of is None else Section("power-law", values_of(self.solid))

    @property
    def has_power_punch(self) -> bool:
        """Whether the punch is r^n / (n Q), so that the units of the paper are defined."""
        return kind_of("punch", self.punch.kind).is_of_the_paper

    @property
    def is_of_the_paper(self) -> bool:
        """Whether it is the problem of three numbers n, k and mu, which every model takes."""
        return all(kind_of(name, getattr(self, name).kind).is_of_the_paper for name in SECTIONS)

    @property
    def has_other_solid_alone(self) -> bool:
        """Whether only the solid keeps it from being the problem of three numbers."""
        return self.power_law is None and all(
            kind_of(name, getattr(self, name).kind).is_of_the_paper for name in ("punch", "law")
        )

    @property
    def tables(self) -> list[str]:
        """The names of the files of its tables."""
        return [section["file"] for section in (self.solid, self.punch, self.law) if "file" in section.values]

    @property
    def digest(self) -> str:
        """SHA-256 of the content; the name of the file does not matter."""
        sections = (self.solid, self.punch, self.law)
        content = [[section.kind, dict(section.values), dict(section.columns)] for section in sections]
        return sha256(json.dumps(content, sort_keys=True, default=str).encode()).hexdigest()

    @property
    def label(self) -> str:
        """The name of the file and the kind of its solid, in one line."""
        return f"{self.path.stem}: {self.solid.kind} solid"
