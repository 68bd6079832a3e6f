"""The one problem of a model: a solid, a punch and a law, dimensionless or in SI."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from hashlib import sha256
from pathlib import Path
from types import ModuleType
from typing import Any

import fscm
from comparisons.model import NotApplicable
from comparisons.numerics.number_text import case_text
from comparisons.problem.kinds import KINDS, PUNCH_SOLID, SECTIONS, SURFACE_KEYS, Form
from comparisons.problem.uncertain import Uncertainty

#: Parameters of a dimensionless problem; nu is optional.
PARAMETERS = ("n", "k", "mu", "nu")

#: Between the name of a problem file and the values of its keys.
BETWEEN = "; "


@dataclass(frozen=True)
class Section:
    """The solid, the punch, the law or the solid of the punch of a problem.

    Attributes
    ----------
    kind : str
    values : mapping of str to float, tuple of float or str
        Numbers in SI, lists of them, words, and the name of the file of a table.
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
        """Return a value, or the default where there is none."""
        return self.values.get(key, default)

    @property
    def content(self) -> dict[str, Any]:
        """The kind and the values, for output."""
        return {"kind": self.kind, **self.values}

    @property
    def surface_keys(self) -> list[str]:
        """Keys of what the surface of a solid has, besides elasticity."""
        return [key for key in SURFACE_KEYS if self.get(key) not in (None, 0.0, "none")]


@dataclass(frozen=True, eq=False)
class Problem:
    """Adhesive contact of a punch with a half-space: what every model is evaluated for.

    `Problem.dimensionless` and `Problem.load` make one.

    Attributes
    ----------
    solid, punch, law : Section
    parameters : mapping of str to float or str
        The named values that a table shows: n, k, mu and perhaps nu of a dimensionless problem; the varied keys of a
        file in SI, by the names of their columns.
    name : str
        The name of the file with the values of its varied keys, or else "problem"; empty for a dimensionless problem.
    path : Path, optional
        The file that was read.
    punch_solid : Section, optional
        The solid of an elastic punch, of a kind of solid; without it the punch is rigid.
    digest : str
        SHA-256 of the content of the file; empty for a dimensionless problem.

    Examples
    --------
    >>> problem = Problem.dimensionless(n=2, k=0.4, mu=1)
    >>> problem.label, problem.solid.kind, problem.mu
    ('n = 2, k = 0.4, mu = 1', 'power-law', 1.0)
    """

    solid: Section
    punch: Section
    law: Section
    parameters: Mapping[str, float | str] = field(default_factory=dict)
    name: str = ""
    path: Path | None = None
    punch_solid: Section | None = None
    digest: str = field(init=False, default="")

    def __post_init__(self) -> None:
        if self.is_dimensionless and self.punch_solid is not None:
            raise ValueError(
                f"punch_solid = {self.punch_solid.kind} is not admissible with n, k and mu: the Tabor number is that "
                "of both bodies together; give mu with 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2"
            )
        if not self.is_dimensionless:
            object.__setattr__(self, "name", self.name or "problem")
            content = [
                [section.kind, dict(section.values), dict(section.columns)] for section in self._sections.values()
            ]
            text = json.dumps(content, sort_keys=True, default=str)
            object.__setattr__(self, "digest", sha256(text.encode()).hexdigest())

    @classmethod
    def dimensionless(cls, n: float, k: float, mu: float, nu: float | None = None) -> Problem:
        """Return the problem of a power-law solid and punch with the 9-3 law.

        Parameters
        ----------
        n, k, mu : float
            Shape index, gradient exponent and Tabor number (see `fscm.Problem`).
        nu : float, optional
            Poisson's ratio in [0, 0.5), for models that solve the physical problem; None leaves it to them.

        Raises
        ------
        ValueError
            With the value, the admissible range and the reason.
        """
        if nu is not None and not 0 <= nu < 0.5:
            raise ValueError(
                f"Poisson's ratio nu = {nu:g} is not in [0, 0.5): "
                "at 0.5 the solid is incompressible and displacements alone do not give the stress"
            )
        posed = fscm.Problem(float(n), float(k), float(mu))
        numbers = {"n": posed.n, "k": posed.k, "mu": posed.mu} | ({} if nu is None else {"nu": float(nu)})
        solid = Section("power-law", {name: numbers[name] for name in ("k", "nu") if name in numbers})
        return cls(solid, Section("power-law", {"n": posed.n}), Section("lennard-jones-9-3", {}), numbers)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Problem:
        """Read a problem file; see `comparisons.problem.reading.load_problem`."""
        # Imported here: a dimensionless problem needs no reader of files.
        from comparisons.problem.reading import load_problem

        return load_problem(path)

    @classmethod
    def of(
        cls,
        solid: Mapping[str, Any],
        punch: Mapping[str, Any],
        law: Mapping[str, Any],
        punch_solid: Mapping[str, Any] | None = None,
        *,
        folder: str | os.PathLike[str] = "",
    ) -> Problem:
        """Return the problem of the sections of a problem file, written in Python.

        Parameters
        ----------
        solid, punch, law : mapping
            The kind and its keys, as in a problem file (``fscm-bench list kinds``).  A value is a text with a unit, as
            "2 GPa" or "2 +- 0.1 GPa", a plain number in SI, a quantity of `pint`, or a number of `uncertainties`, in
            SI or as the magnitude of a quantity.
        punch_solid : mapping, optional
            The solid of an elastic punch.
        folder : path
            That of the tables which a section names; by default the current one.

        Raises
        ------
        ValueError
            One sentence with key, value and remedy.

        Examples
        --------
        >>> bead = Problem.of(
        ...     solid={"kind": "homogeneous", "E": "1.5 MPa", "nu": 0.49},
        ...     punch={"kind": "sphere", "R": "5 um"},
        ...     law={"kind": "lennard-jones-9-3", "work_of_adhesion": "50 mJ/m^2", "z0": "3 nm"},
        ... )
        >>> bead["solid.E"], round(bead.mu, 2)
        (1500000.0, 49.16)
        """
        from comparisons.problem.reading import problem_of_sections

        sections = {"solid": solid, "punch": punch, "law": law}
        return problem_of_sections(sections if punch_solid is None else sections | {PUNCH_SOLID: punch_solid}, folder)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Problem) and (self.digest, self.key) == (other.digest, other.key)

    def __hash__(self) -> int:
        return hash((self.digest, self.key))

    def __lt__(self, other: Problem) -> bool:
        return self._order < other._order

    def __getitem__(self, key: str) -> Any:
        """Return a parameter, or the value of a key as "solid.E0", None if there is none.

        ``solid.kind`` is the kind of the solid, and ``solid.thickness.2`` the second entry of a list.
        """
        name, _, key_of_section = key.partition(".")
        if not key_of_section:
            return self.parameters.get(key)
        section = self._sections.get(name)
        if section is None:
            return None
        key, _, number = key_of_section.partition(".")
        value = section.content.get(key)
        if number and isinstance(value, tuple) and 1 <= int(number) <= len(value):
            return value[int(number) - 1]
        return None if number else value

    @property
    def is_dimensionless(self) -> bool:
        """Whether n, k and mu state the problem: its law has neither a work of adhesion nor a length."""
        return not self.law.values

    @cached_property
    def _sections(self) -> dict[str, Section]:
        """The sections that the problem has, by name."""
        sections = {name: getattr(self, name) for name in (*SECTIONS, PUNCH_SOLID)}
        return {name: section for name, section in sections.items() if section is not None}

    def section(self, name: str) -> Section:
        """Return a section by its name; `ValueError`, one sentence, if the problem does not have it."""
        if name not in self._sections:
            raise ValueError(f"{self.label} has no section [{name}]: its punch is rigid; write its kind and keys")
        return self._sections[name]

    @cached_property
    def _order(self) -> tuple[Any, ...]:
        """What problems are sorted by: n, k, mu and nu, then those of files by file and the values of varied keys."""
        n, k, mu, nu = (self[name] for name in PARAMETERS)
        numbers = (math.inf if number is None else number for number in (n, k, mu))
        varied = [(name, value) for name, value in self.parameters.items() if name not in PARAMETERS]
        # Numbers before texts, of one key.
        values = [(name, isinstance(value, str), value) for name, value in varied]
        return *numbers, -1.0 if nu is None else nu, split_name(self.name)[0], values, self.name

    @property
    def label(self) -> str:
        """The name, or else the parameters, in one line for people."""
        return case_text(self.parameters) if self.is_dimensionless else self.name

    @property
    def content(self) -> dict[str, Any]:
        """The content for output: the name of the file and its sections."""
        sections = {name: section.content for name, section in self._sections.items()}
        return {"file": "" if self.path is None else self.path.name, **sections}

    @cached_property
    def key(self) -> tuple[float | None, float | None, float | None, float | None, str]:
        """The values of the columns of a table that identify a problem."""
        n, k, mu, nu = (self[name] for name in PARAMETERS)
        return n, k, mu, nu, self.name

    @property
    def tables(self) -> list[str]:
        """The names of the files of its tables."""
        return [section["file"] for section in self._sections.values() if "file" in section.values]

    @property
    def uncertain(self) -> dict[str, Uncertainty]:
        """What is uncertain, by names such as "solid.E0"."""
        sections = self._sections.items()
        return {f"{name}.{key}": spread for name, section in sections for key, spread in section.uncertain.items()}

    @property
    def numbers_of_sections(self) -> list[str]:
        """Names such as "solid.E0" of the keys whose value is one number."""
        return [
            f"{name}.{key}"
            for name, section in self._sections.items()
            for key, value in section.values.items()
            if isinstance(value, float)
        ]

    def form(self, name: str) -> Form:
        """Return what the table of kinds states of a key, as "solid.E0", or of the list of an entry."""
        section, key, *_ = name.split(".")
        return KINDS[section][self._sections[section].kind].keys[key]

    def is_of_the_paper(self, *names: str) -> bool:
        """Whether the problem of three numbers n, k and mu, which every model takes, has the kinds of these sections.

        By default of all.  The solid of such a problem is E0 (z/c0)^k, or that of two bodies with one k, whose surface
        has neither tension nor friction; its law acts at the vertical gap.
        """
        if "law" in (names or SECTIONS) and self.interaction == "body":
            return False
        if "solid" in (names or SECTIONS) and not self._is_one_power_law:
            return False
        return all(KINDS[name][self._sections[name].kind].is_of_the_paper for name in names or SECTIONS)

    @property
    def bodies(self) -> list[Section]:
        """The solid, and that of an elastic punch."""
        return [self.solid] if self.punch_solid is None else [self.solid, self.punch_solid]

    @property
    def surface(self) -> dict[str, float | str]:
        """What the surfaces of the bodies have besides elasticity: surface tensions and friction, by names of keys."""
        sections = self._sections.items()
        return {f"{name}.{key}": section[key] for name, section in sections for key in section.surface_keys}

    def without(self, *names: str) -> Problem:
        """Return the problem without some keys, as "solid.surface_tension"."""
        problem = self
        for name in names:
            section, _, key = name.partition(".")
            body = problem._sections[section]
            values = {other: value for other, value in body.values.items() if other != key}
            changed: dict[str, Any] = {section: replace(body, values=values)}
            problem = replace(problem, **changed)
        return problem

    @property
    def interaction(self) -> str:
        """Where the surface force is taken: "derjaguin", unless the file states "body"."""
        return str(self.law.get("interaction", "derjaguin"))

    @cached_property
    def _is_one_power_law(self) -> bool:
        """Whether the compliance of the surface is that of one power law."""
        kinds = [KINDS["solid"][body.kind] for body in self.bodies]
        exponents = {body.get("k", 0.0) for body in self.bodies}
        return all(kind.is_of_the_paper for kind in kinds) and len(exponents) == 1 and not self.surface

    @property
    def n(self) -> float:
        """Shape index; `NotApplicable` where solid or punch is not a power law, as for `k` and `mu`."""
        return self._number("n")

    @property
    def k(self) -> float:
        """Gradient exponent."""
        return self._number("k")

    @property
    def mu(self) -> float:
        """Generalised Tabor number (Eq. 29)."""
        return self._number("mu")

    @property
    def nu(self) -> float | None:
        """Poisson's ratio of one body of a problem of the paper; None if a dimensionless one does not prescribe it."""
        return self.solid.get("nu") if self.is_of_the_paper() and self.punch_solid is None else None

    def _number(self, name: str) -> float:
        if not self.is_of_the_paper("solid", "punch"):
            raise NotApplicable(
                f"{self.label} has no {name}: it has {self.parts}; n, k and mu are those of power laws, two bodies "
                "have them with one k, and surfaces without tension and friction"
            )
        return float(getattr(self.posed, name))

    @property
    def parts(self) -> str:
        """The kinds of the sections in words, with what the surfaces have.

        Examples
        --------
        >>> Problem.dimensionless(2, 0.4, 1).parts
        'a power-law solid (k = 0.4), a power-law punch and a lennard-jones-9-3 law'
        """
        kinds = [f"a {_described(self.solid)}", f"a {self.punch.kind} punch", f"a {self.law.kind} law"]
        if self.punch_solid is not None:
            kinds[1] += f" of a {_described(self.punch_solid)}"
        of_body = " of the whole punch (interaction = body)" if self.interaction == "body" else ""
        return f"{kinds[0]}, {kinds[1]} and {kinds[2]}{of_body}"

    @property
    def numbers(self) -> dict[str, float]:
        """Values of n, k, mu and nu, without nu if it is not prescribed."""
        numbers = {"n": self.n, "k": self.k, "mu": self.mu}
        return numbers if self.nu is None else {**numbers, "nu": self.nu}

    def build(self, solver: ModuleType) -> Any:
        """Return the physical problem of a solver, `fscm` or `fem_reference`, in SI.

        Raises
        ------
        ValueError
            If it is outside of what the solver admits.
        """
        sections = self._sections.items()
        # The punch_solid stands last, as in both solvers.
        parts = (KINDS[name][section.kind].build(solver, section) for name, section in sections)
        return solver.Problem(*parts, interaction=self.interaction)

    @property
    def posed(self) -> fscm.Problem:
        """The dimensionless problem of `fscm`.

        Examples
        --------
        >>> solid = Section("power-law", {"E0": 70e9, "c0": 1.0, "k": 0.0, "nu": 0.2})
        >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
        >>> silica = Problem(solid, Section("sphere", {"R": 1e-6}), law)
        >>> round(silica.posed.mu, 6), silica.units["displacement"]
        (0.259204, 3e-10)
        """
        return _of_fscm(self).dimensionless

    @property
    def units(self) -> Mapping[str, float]:
        """What a dimensionless value is multiplied by, by kind, as of `fscm.Problem.units`."""
        return _of_fscm(self).units

    def at(self, parameters: Mapping[str, float]) -> Problem:
        """Return a dimensionless problem with other values of some parameters.

        Examples
        --------
        >>> Problem.dimensionless(2, 0.4, 1.0).at({"k": 1.0}).label
        'n = 2, k = 1, mu = 1'
        """
        values: dict[str, Any] = {**self.parameters, **parameters}
        return Problem.dimensionless(**values) if parameters else self

    def without_nu(self) -> Problem:
        """Return a dimensionless problem without Poisson's ratio; any other is the same without a change."""
        return Problem.dimensionless(self.n, self.k, self.mu) if "nu" in self.parameters else self

    def with_value(self, name: str, value: float) -> Problem:
        """Return the problem with another value of a key, as "solid.E0", in SI."""
        section, _, key = name.partition(".")
        changed_section = self._sections[section]
        changed: dict[str, Any] = {section: replace(changed_section, values={**changed_section.values, key: value})}
        return replace(self, **changed)


@lru_cache(maxsize=1024)
def _of_fscm(problem: Problem) -> fscm.Problem:
    if problem.is_dimensionless:
        return fscm.Problem(problem["n"], problem["k"], problem["mu"])
    return problem.build(fscm)


def beyond_numbers(problem: Problem | fscm.Problem, model: str) -> str | None:
    """Return why a model of n, k and mu does not take a problem, which has more; None if it has not.

    A problem of `fscm` stands for its n, k and mu.

    Examples
    --------
    >>> beyond_numbers(Problem.dimensionless(2, 0.4, 1), "jkr") is None
    True
    """
    if not isinstance(problem, Problem) or problem.is_of_the_paper():
        return None
    return (
        f"{model} takes a power-law or homogeneous solid, or two of one k, with neither surface tension nor "
        f"friction, a sphere, cone or power-law punch and the 9-3 law; this problem has {problem.parts}"
    )


def _described(body: Section) -> str:
    """The kind of a solid, with its exponent and what its surface has, in words."""
    exponent = f" (k = {body['k']:g})" if body.kind == "power-law" and "k" in body.values else ""
    return f"{body.kind} solid{exponent}" + "".join(f" with {key.replace('_', ' ')}" for key in body.surface_keys)


def split_name(name: str) -> list[str]:
    """Return the name of the file, and the values of its varied keys, of the name of a problem.

    Examples
    --------
    >>> split_name("pad.toml; solid.thickness=12 nm")
    ['pad.toml', 'solid.thickness=12 nm']
    """
    return name.split(BETWEEN)
