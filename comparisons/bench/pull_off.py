"""Pull-off force of one problem by each solver, with its CPU time."""

from __future__ import annotations

from typing import Any

import numpy as np

import fem_reference
import fscm
from comparisons.bench import adhesion_package
from comparisons.bench.measuring import cpu_seconds
from comparisons.bench.part import Numbers, Settings
from fscm.problem import Problem
from fscm.stieltjes import StieltjesScheme, find_event

__all__ = ["FSCM_ACCURACIES", "edge_width", "measure", "solved"]

#: Relative errors that `fscm` accepts, from the coarsest to the finest.
FSCM_ACCURACIES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)

#: Before anything is timed, a neighbouring problem is solved: its Tabor number differs by this factor.
_WARM = 1.1
#: Repetitions have Tabor numbers that differ by this much, so that no stored solution serves them.
_APART = 1e-6

#: Scales of the physical problem that the finite elements get; no result depends on them.
_SCALES = {"c0": 3.0, "Q": 2.0, "work_of_adhesion": 0.7, "z0": 0.25, "nu": 0.3}


def measure(settings: Settings) -> Numbers:
    """Return the pull-off force of a problem by a solver: value, bound, unknowns and CPU time.

    Parameters
    ----------
    settings : dict
        ``model``, ``n``, ``k``, ``mu``, and by model: ``accuracy`` (fscm, fem), ``segments`` (fscm-stieltjes),
        ``half_width`` and ``points`` (adhesion).
    """
    return _MODELS[settings["model"]](settings)


def _problem(settings: Settings, repetition: int = 0) -> Problem:
    return Problem(settings["n"], settings["k"], settings["mu"] * (1.0 + _APART * repetition))


def _numbers(value: float, u_num: float | None, unknowns: int, seconds: float) -> Numbers:
    return {"value": value, "u_num": u_num, "unknowns": unknowns, "cpu_seconds": seconds}


def solved(settings: Settings) -> Numbers:
    """Solve a problem by `fscm` at an accuracy."""
    accuracy = settings["accuracy"]
    fscm.solve(_problem({**settings, "mu": _WARM * settings["mu"]}), "pull_off_force", accuracy)
    solution, seconds = cpu_seconds(lambda i: fscm.solve(_problem(settings, i), "pull_off_force", accuracy))
    return _numbers(solution.value, solution.u_num, solution.size, seconds)


def _elements(settings: Settings) -> Numbers:
    """Solve by the finite elements; the problem is physical, with its load in the unit of the pull-off force."""
    accuracy = settings["accuracy"]

    def solve(repetition: int) -> tuple[Any, float]:
        physical = _problem(settings, repetition).in_units(**_SCALES)
        solid: Any = physical.solid
        body = fem_reference.Problem(
            fem_reference.PowerLaw(E0=solid.E0, c0=solid.c0, k=solid.k, nu=solid.nu),
            fem_reference.PowerPunch(n=physical.n, Q=_SCALES["Q"]),
            fem_reference.LennardJones(work_of_adhesion=_SCALES["work_of_adhesion"], z0=_SCALES["z0"]),
        )
        return fem_reference.solve(body, "pull_off_force", accuracy), physical.units["load"]

    (solution, unit), seconds = cpu_seconds(solve)
    return _numbers(solution.value / unit, solution.u_num / unit, solution.size, seconds)


def _stieltjes(settings: Settings) -> Numbers:
    """Solve by the Stieltjes scheme; its table of the kernel, which depends on k and N only, is made before."""
    segments = settings["segments"]
    StieltjesScheme(_problem(settings), segments).solve(10.0)
    event, seconds = cpu_seconds(lambda i: find_event(StieltjesScheme(_problem(settings, i), segments), "pull_off"))
    return _numbers(-event.load, None, segments, seconds)


def _fft(settings: Settings) -> Numbers:
    """Solve by the package `adhesion`, which gets the displacement at pull-off from `fscm`."""
    mu, half_width, points = settings["mu"], settings["half_width"], settings["points"]
    displacement = fscm.solve(_problem(settings), "pull_off_displacement").value
    # The first call imports the package.
    adhesion_package.pull_off(mu, half_width, 8, displacement)
    (force, evaluations), seconds = cpu_seconds(
        lambda _: adhesion_package.pull_off(mu, half_width, points, displacement)
    )
    return _numbers(force, None, points**2, seconds) | {"evaluations": evaluations}


_MODELS = {"fscm": solved, "fem": _elements, "fscm-stieltjes": _stieltjes, "adhesion": _fft}


def edge_width(problem: Problem) -> float:
    """Width of the cohesive edge at pull-off relative to its radius: from the largest tension to one z0 farther apart.

    Examples
    --------
    >>> edge_width(Problem(2, 0, 5.0)) < edge_width(Problem(2, 0, 1.0)) < 1.0
    True
    """
    surface = fscm.profile(problem)
    peak = problem.law.peak_gap
    outside = slice(int(np.flatnonzero(surface.gap <= peak)[-1]), None)
    inner, outer = np.interp([peak, peak + 1.0], surface.gap[outside], surface.radius[outside])
    return float(outer / inner - 1.0)
