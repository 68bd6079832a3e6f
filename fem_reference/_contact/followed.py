"""Events of a solid that does not scale, and the meshes that are fine at their contact edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Protocol

from fem_reference._contact.completeness import complete_path, displacement_range
from fem_reference._contact.contact import Contact
from fem_reference._contact.edge_states import EdgeStates
from fem_reference._contact.events import JUMP_IN, LANDING, SEPARATED, PathEvents, beginning_of, excess_of
from fem_reference._contact.jkr_tension import last_turn
from fem_reference._contact.mesh_lengths import EDGE_PER_BALANCE, WIDEST, check_width, kinks_within, spot_length
from fem_reference._contact.multimesh_events import MultimeshEvents
from fem_reference._contact.multimesh_path import FARTHER, multimesh_path
from fem_reference._contact.path import WIDTH_SHARE, Point, edge_width, equilibrium_points
from fem_reference._contact.tracing import beginning
from fem_reference._elastic.compliance import is_scaling
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import SEARCH_DEGREE, Level
from fem_reference.problem import Problem

__all__ = ["FollowedPath"]

#: Difference of two minima, relative to the load or in lengths of the law, up to which their own meshes decide.
TIE = 1e-2

#: Resolved edge width of an event, as `fem_reference._contact.path.WIDTH_SHARE`: the edge moves over the elements
#: there, and the rates have the error of a load divided by the length of an element.
EVENT_SHARE = 0.07

#: Density of the mesh for the limit of a short range: an element is at most half as long as its distance.
SCAN_DENSITY = 0.5

#: Width of an edge, relative to its radius, below which the rates on one mesh do not tell an extremum: they have the
#: error of a load divided by the length of an element (measured at a Tabor number of 1000, with a width of 7e-7: they
#: vanish at a radius 1e-3 too small, where the load is 1.9e-6 above its minimum).
NARROW_EDGE = 2e-4

#: Ratio of the width of an edge to the length of balance that it does not exceed where the edge is sharp (measured: 2.2
#: at the pull-off on a soft layer with a Tabor number of 160).
WIDEST_EDGE = 5.0


class _Choice(Protocol):
    """What makes meshes of a problem: `fem_reference._contact.mesh_choice.MeshChoice`."""

    @property
    def problem(self) -> Problem: ...

    @property
    def level(self) -> Level: ...

    def spec_at(self, width: float, radius: float) -> MeshSpec: ...

    def contact(self, spec: MeshSpec, size: float) -> Contact: ...


class FollowedPath:
    """The path of a problem, each state in contact on a mesh that resolves its edge.

    Parameters
    ----------
    choice : MeshChoice
        Of a solid that does not scale.
    first : tuple of MeshSpec and float
        The mesh on which the path begins.
    """

    def __init__(self, choice: _Choice, initial: tuple[MeshSpec, float]) -> None:
        self._choice, self._first = choice, initial
        self._degree = SEARCH_DEGREE

    @cached_property
    def _approach(self) -> tuple[list[Point], Point]:
        """The path before contact, and its first state in contact, on the first mesh."""
        spec, size = self._first
        points = equilibrium_points(self._choice.contact(replace(spec, order=self._degree), size))
        approach: list[Point] = []
        for point in points:
            if point.branch.touching:
                *approach, contact_start = complete_path([*approach, point])
                return approach, contact_start
            approach.append(point)
        raise AssertionError("a path that does not reach contact raises NotConverged")

    def events(self, event: str = "") -> PathEvents:
        """Return the events of the path; for a jump into contact before there is an edge, of that part of it.

        Raises
        ------
        NotConverged
            If the path cannot be followed.
        """
        return PathEvents(self._approach[0]) if event == JUMP_IN and self._jumps_before_contact() else self._whole

    def _jumps_before_contact(self) -> bool:
        return any(point.displacement_rate <= 0.0 for point in self._approach[0])

    @cached_property
    def _whole(self) -> MultimeshEvents:
        problem, turn = self._choice.problem, self._last_turn()
        # Edges beyond reach are refused here, and not after minutes.
        scaling = is_scaling(problem.solid.modulus, problem.solid.poisson, kinks_within(problem))
        ratio = EDGE_PER_BALANCE / FARTHER if scaling else WIDEST_EDGE
        check_width(ratio * WIDTH_SHARE * spot_length(problem, self._first[1]) / turn)
        approach, contact_start = self._approach
        states = EdgeStates(self._choice, contact_start, self._degree, self._choice.level.density)
        highest = displacement_range(approach)[1]
        touching = multimesh_path(states, contact_start.edge_radius, turn, kinks_within(problem), highest)
        before = complete_path([*beginning(approach, touching), *approach])
        return MultimeshEvents(before, touching, states)

    def _last_turn(self) -> float:
        """Radius beyond which neither load nor displacement turns back."""
        size = self._first[1]
        spec = replace(self._choice.spec_at(WIDEST, size), density=SCAN_DENSITY, order=self._degree)
        return last_turn(self._choice.contact(spec, size), size)

    def mesh(self, event: str) -> tuple[MeshSpec, float]:
        """Return the mesh that is fine at the contact edge of an event, and the radius of that edge.

        Raises
        ------
        NoSuchEvent
            If the path has no such point.
        NotConverged
            As `events`, or if the edge is narrower than a mesh can resolve.
        """
        if event == JUMP_IN and self._jumps_before_contact():
            return self._first
        located = [self._located(event, point) for point in self._lowest(event)]
        mesh, point, slope = min(located, key=lambda mesh_and_point: _height(event, mesh_and_point[1]))
        self._whole.take(event, point, slope)
        return mesh

    def _lowest(self, event: str) -> Sequence[Point]:
        """The state at an event, and others that may be it on their own meshes."""
        deepest = self._whole.at(event)
        if event not in ("pull_off", "jump_out"):
            return [deepest]
        unit = abs(deepest.state.load) if event == "pull_off" else self._choice.problem.law.z0
        limit = _height(event, deepest) + TIE * unit
        return [point for point in self._whole.minima(event) if _height(event, point) <= limit]

    def _located(self, event: str, point: Point) -> tuple[tuple[MeshSpec, float], Point, float]:
        """The mesh for the edge of an event, its state there, and the slope of what vanishes."""
        slope, beginning = self._whole.slope(event, point), beginning_of(event)
        # A further jump begins at an edge for which this mesh is not fine: its end is kept where the path has it.
        held = beginning is not None and event not in (LANDING, SEPARATED)
        if not point.branch.touching:
            return self._first, replace(point, held=held), slope
        level = 0.0 if beginning is None else self._whole.at(beginning).state.displacement
        # Its own finest mesh decides where the edge is, because the rates on coarser ones are less certain.
        order, density = self._choice.level.order, self._choice.level.density
        if beginning is None and event != "zero_load" and edge_width(point) < NARROW_EDGE:
            states = EdgeStates(self._choice, point, order, density, EVENT_SHARE)
            radius, slope = states.extremum(lambda state: _height(event, state))
            spec, point_there = EdgeStates(self._choice, states.start, order, density, EVENT_SHARE).own(radius)
            return (spec, radius), replace(point_there, held=True), slope
        states = EdgeStates(self._choice, point, order, density, EVENT_SHARE)
        excess = excess_of(event, level)
        spec, radius = states.located(excess, slope)
        if held:
            radius -= excess(states.start) / slope
            spec, point_there = states.own(radius)
            return (spec, radius), replace(point_there, held=True), slope
        return (spec, radius), states.start, slope


def _height(event: str, point: Point) -> float:
    """Load or displacement, the lowest of which is the event."""
    return point.state.load if event == "pull_off" else point.state.displacement
