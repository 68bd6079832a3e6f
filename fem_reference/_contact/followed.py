"""The path of a problem, each state in contact on a mesh that resolves its edge, and the meshes of its events."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property, lru_cache

from fem_reference._contact.bodies import are_one_power_law
from fem_reference._contact.completeness import complete_path, displacement_range
from fem_reference._contact.cusp import slowest_sample
from fem_reference._contact.edge_states import EdgeStates
from fem_reference._contact.event_kinds import (
    CUSP,
    JUMP_IN,
    LANDING,
    SEPARATED,
    Anchor,
    beginning_of,
    beyond_pull_off,
    excess_of,
)
from fem_reference._contact.events import PathEvents
from fem_reference._contact.jkr_tension import last_turn
from fem_reference._contact.mesh_lengths import (
    EDGE_PER_BALANCE,
    EDGE_RISE,
    WIDEST,
    balance_length,
    check_width,
    kinks_within,
    spot_length,
)
from fem_reference._contact.meshes import Meshes
from fem_reference._contact.other_lengths import other_lengths
from fem_reference._contact.path import BEYOND_LAST_TURN, approach, beginning, completed, contact_points, traced
from fem_reference._contact.states import NARROWER, WIDTH_SHARE, Point, edge_width
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import SEARCH_DEGREE
from fem_reference.errors import Failure, NotConverged
from fem_reference.punch import radius_at_height

__all__ = ["FollowedPath", "followed_path", "path_on"]

#: Difference of two minima, relative to the load or in lengths of the law, up to which their own meshes decide.
TIE = 1e-2

#: Resolved edge width of an event, as `fem_reference._contact.path.WIDTH_SHARE`: the edge moves over the elements
#: there, and the rates have the error of a load divided by the length of an element.
EVENT_SHARE = 0.07

#: Height of a punch, in lengths of the law, up to which its path is followed at least: nearer, the range of the law may
#: move an extremum by more than in the limit of a short range.
REACH = 4.0

#: Density of the mesh for the limit of a short range: an element is at most half as long as its distance.
SCAN_DENSITY = 0.5

#: Width of an edge, relative to its radius, below which the rates on one mesh do not tell an extremum: they have the
#: error of a load divided by the length of an element (measured at a Tabor number of 1000, with a width of 7e-7: they
#: vanish at a radius 1e-3 too small, where the load is 1.9e-6 above its minimum).
NARROW_EDGE = 2e-4

#: Largest difference of the logarithms of the radii at which the rates on one mesh vanish and the values of states on
#: similar meshes have their extremum: beyond, the latter is taken.  Rates have the error of a load divided by the
#: length of an element, which may be the same with several degrees (measured: 0.012 and 0.06 under a cone on three
#: stiff layers of 50 nm on a soft solid, where the load was up to 0.26 % above its minimum; 1e-5 is usual).
FARTHEST = 1e-3

#: Change of the logarithm of the radius to a state beside it: the rise of its value, less that by the slope of the
#: path, has the extremum to half of it times the error of that slope (measured: up to 8 %).
BESIDE_EXTREMUM = 2e-4

#: Ratio of the width of an edge to the length of balance that it does not exceed where the edge is sharp (measured: 2.2
#: at the pull-off on a soft layer with a Tabor number of 160).
WIDEST_EDGE = 5.0

#: Ratio of the density of the first mesh for the spot on which contact begins to that of the others, and the largest
#: number of such meshes.
SPOT_DENSITY, SPOT_MESHES = 1.5, 6

#: Largest number of meshes for a spot that is about where it is expected: the second has the spot found on the first.
EXPECTED_SPOTS = 3

#: Largest number of meshes tried for the edge where folds merge, and of those in a row on which the path cannot be
#: traced.
CUSP_MESHES, FAILURES = 10, 3


class FollowedPath:
    """The path of a problem, each state in contact on a mesh that resolves its edge.

    Parameters
    ----------
    meshes : Meshes
    """

    def __init__(self, meshes: Meshes) -> None:
        self._meshes = meshes

    @cached_property
    def meshes(self) -> Meshes:
        """The meshes; those that scale extend as far from the spot on which contact begins."""
        return self._begun[0]

    @cached_property
    def _begun(self) -> tuple[Meshes, tuple[list[Point], Point] | None]:
        """The meshes, and the path before contact on the first of them if it has been followed there."""
        if not self._meshes.scale:
            return self._meshes, None
        meshes = self._meshes.expected
        for _ in range(EXPECTED_SPOTS):
            spec, size = meshes.first()
            try:
                separate, start = approach(meshes.contact(replace(spec, order=SEARCH_DEGREE), size))
                meshes = replace(meshes, spot=_spot(separate, start))
                if meshes.first()[0] == spec:
                    return meshes, _completed(separate, start)
            except NotConverged:
                break
        return self._searched(), None

    def _searched(self) -> Meshes:
        """The meshes of a spot that is not where it is expected, found from a larger one."""
        meshes, density = self._meshes, SPOT_DENSITY
        for _ in range(SPOT_MESHES):
            spec, size = meshes.first()
            try:
                coarse = replace(spec, order=SEARCH_DEGREE, density=density * spec.density)
                separate, start = approach(meshes.contact(coarse, size))
            except NotConverged:
                if density == 1.0:
                    # Contact begins on a spot as small as the solid and the law allow, far from the rest of the punch.
                    spot = min(meshes.spot, balance_length(meshes.problem, size))
                    meshes = replace(meshes, spot=spot, failures=meshes.failures + 1)
                density = 1.0
            else:
                meshes = replace(meshes, spot=min(meshes.spot, _spot(separate, start)))
                if meshes.first()[0] == spec:
                    break
        return meshes

    @cached_property
    def _first(self) -> tuple[MeshSpec, float]:
        """The mesh on which the path begins."""
        return self.meshes.first()

    @cached_property
    def _approach(self) -> tuple[list[Point], Point]:
        """The path before contact, and its first state in contact, on the first mesh."""
        begun = self._begun[1]
        if begun is not None:
            return begun
        spec, size = self._first
        return _completed(*approach(self.meshes.contact(replace(spec, order=SEARCH_DEGREE), size)))

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
    def _whole(self) -> PathEvents:
        meshes, kinks = self.meshes, kinks_within(self.meshes.problem)
        turn = 0.0 if meshes.scale else self._last_turn(kinks)
        separate, start = self._approach
        states = EdgeStates(meshes, start, SEARCH_DEGREE, meshes.level.density)
        if meshes.scale:
            states.states[start.parameter] = start
        highest = displacement_range(separate)[1]
        # States on the same solid, also of another problem, share compliances.
        unit = math.nan if meshes.scale else meshes.problem.law.z0
        points = contact_points(states.at, start.edge_radius, kinks, highest, turn, meshes.scale, unit)
        touching = completed(states.at, points, meshes.scale)
        before = complete_path([*beginning(separate, touching), *separate])
        return PathEvents((*before, *touching), states.at)

    def _last_turn(self, kinks: tuple[float, ...]) -> float:
        """Radius beyond which neither load nor displacement turns back; edges out of reach up to it are refused."""
        problem = self.meshes.problem
        size = radius_at_height(problem.punch, REACH * problem.law.z0)
        spec = replace(self.meshes.spec_at(WIDEST, size), density=SCAN_DENSITY, order=SEARCH_DEGREE)
        turn = last_turn(self.meshes.contact(spec, size), size)
        ratio = EDGE_PER_BALANCE / BEYOND_LAST_TURN if not kinks and are_one_power_law(problem.solids) else WIDEST_EDGE
        check_width(ratio * WIDTH_SHARE * spot_length(problem, size) / turn)
        return turn

    def mesh(
        self,
        events: Sequence[str],
        start: tuple[MeshSpec, float] | None = None,
        force_alone: bool = False,
    ) -> tuple[MeshSpec, float]:
        """Return the mesh that is fine at the contact edge of the first event, and the radius of that edge.

        A mesh that scales is fine at the edges of all of them.

        Parameters
        ----------
        events : sequence of str
        force_alone : bool
            Whether the least load alone is wanted: a mesh that scales may end nearer.
        start : tuple, optional
            The mesh and size of a similar problem, to begin with at the cusp.

        Raises
        ------
        NoSuchEvent
            If the path has no such point.
        NotConverged
            As `events`, or if the edge is narrower than a mesh can resolve.
        """
        event = events[0]
        if event == CUSP:
            return self._mesh_of_cusp(start)
        if self.meshes.scale:
            return self._mesh_of_all(events, force_alone)
        if event == JUMP_IN and self._jumps_before_contact():
            return self._first
        located = [self._located(event, point) for point in self._lowest(event)]
        mesh, anchor = min(located, key=lambda mesh_and_anchor: _height(event, mesh_and_anchor[1].point))
        self._whole.relocate(event, anchor)
        return mesh

    def _mesh_of_all(self, events: Sequence[str], force_alone: bool) -> tuple[MeshSpec, float]:
        """The mesh for the narrowest edge of the part of the path in which several events are, with the pull-off."""
        if events[0] == JUMP_IN and self._jumps_before_contact():
            return self._first
        points = self._whole.points
        for event in events:
            self._whole.at(event)
        if not any(beyond_pull_off(event) for event in events):
            # Beyond the pull-off the edge is sharper relative to its radius, but that part is not needed.
            deepest = min(range(len(points)), key=lambda i: points[i].state.load)
            points = points[: deepest + 3]
        spec, size = self._mesh_of(points)
        if force_alone:
            # Contact begins on a spot that may be much smaller than the contact at the pull-off.
            spec = self.meshes.ended(spec, self._whole.at(events[0]).state.size)
        return spec, size

    def mesh_of_path(self) -> tuple[MeshSpec, float]:
        """Return the mesh that scales and is fine at every edge of the path, and its size.

        Raises
        ------
        NotConverged
            As `mesh`.
        """
        return self._mesh_of(self._whole.points)

    def _mesh_of(self, points: Sequence[Point]) -> tuple[MeshSpec, float]:
        narrowest = min((edge_width(point) for point in points if point.branch.touching), default=WIDEST)
        width = min(WIDTH_SHARE * narrowest, self._first[0].edge_width)
        check_width(width)
        size = self._first[1]
        return self.meshes.spec_at(width, size), size

    def _mesh_of_cusp(self, start: tuple[MeshSpec, float] | None) -> tuple[MeshSpec, float]:
        """The mesh for the edge where folds merge, on which the whole path is traced: they merge before it is sharp."""
        meshes, failures = self.meshes, 0
        problem = meshes.problem
        spec, size = self._first
        if start is not None:
            spec, size = start
        elif not meshes.scale:
            size = radius_at_height(problem.punch, EDGE_RISE * problem.law.z0)
            spec = meshes.spec_at(0.5 * balance_length(problem, size) / size, size)
        for _ in range(CUSP_MESHES):
            width = NARROWER * spec.edge_width
            try:
                samples = path_on(meshes, replace(spec, order=SEARCH_DEGREE), size).samples
            except NotConverged:
                failures += 1
                if failures == FAILURES:
                    raise
            else:
                edges = [point for point in samples[: slowest_sample(samples) + 2] if point.branch.touching]
                narrowest = min(map(edge_width, edges), default=WIDEST)
                # The gap falls at the edge of a mesh that is too coarse to tell the width.
                width, failures = (WIDTH_SHARE * narrowest if narrowest > 0.0 else width), 0
                if width >= spec.edge_width:
                    return spec, size
            check_width(width)
            spec = meshes.spec_at(width, size)
        raise NotConverged(
            "the width of the contact edge was not found: the edge is narrower than the mesh can resolve", Failure.MESH
        )

    def _lowest(self, event: str) -> Sequence[Point]:
        """The state at an event, and others that may be it on their own meshes."""
        deepest = self._whole.at(event)
        if event not in ("pull_off", "jump_out"):
            return [deepest]
        unit = abs(deepest.state.load) if event == "pull_off" else self.meshes.problem.law.z0
        limit = _height(event, deepest) + TIE * unit
        return [point for point in self._whole.minima(event) if _height(event, point) <= limit]

    def _located(self, event: str, point: Point) -> tuple[tuple[MeshSpec, float], Anchor]:
        """The mesh for the edge of an event, and the event there."""
        slope, beginning = self._whole.slope(event, point), beginning_of(event)
        # A further jump begins at an edge for which this mesh is not fine: its end stays where the path has it.
        pinned = beginning is not None and event not in (LANDING, SEPARATED)
        if not point.branch.touching:
            return self._first, Anchor(replace(point, pinned=pinned), slope)
        level = 0.0 if beginning is None else self._whole.at(beginning).state.displacement
        # Its own finest mesh decides where the edge is, because the rates on coarser ones are less certain.
        order, density = self.meshes.level.order, self.meshes.level.density
        is_extremum = beginning is None and event != "zero_load"
        if is_extremum and edge_width(point) < NARROW_EDGE:
            return self._extremum(event, point)
        states = EdgeStates(self.meshes, point, order, density, EVENT_SHARE)
        excess = excess_of(event, level)
        spec, radius = states.located(excess, slope)
        if is_extremum:
            here = _height(event, states.start)
            rise = _height(event, states.similar(spec, radius * math.exp(BESIDE_EXTREMUM))) - here
            bend = slope * radius**2
            if kinks_within(self.meshes.problem):
                # Near a kink the path bends within the width of the edge, which its states do not tell.
                fall = here - _height(event, states.similar(spec, radius * math.exp(-BESIDE_EXTREMUM)))
                turned, bend = bend < 0.0, (rise - fall) / BESIDE_EXTREMUM**2
                slope = bend / radius**2
                if turned != (bend < 0.0):
                    return self._extremum(event, states.start)
            moved = (rise / BESIDE_EXTREMUM - radius * excess(states.start)) / bend if bend else math.inf
            radius_error = abs(moved - 0.5 * BESIDE_EXTREMUM)
            if radius_error > FARTHEST:
                return self._extremum(event, states.start)
            return (spec, radius), Anchor(states.start, slope, radius_error)
        if pinned:
            radius -= excess(states.start) / slope
            spec, point_there = states.on_fine_mesh(radius)
            return (spec, radius), Anchor(replace(point_there, pinned=True), slope)
        return (spec, radius), Anchor(states.start, slope)

    def _extremum(self, event: str, point: Point) -> tuple[tuple[MeshSpec, float], Anchor]:
        """As `_located`, by the values of states beside it; other elements tell the error of the radius."""
        order, density = self.meshes.level.order, self.meshes.level.density

        def states_near(start: Point, order: int, density: float) -> EdgeStates:
            return EdgeStates(self.meshes, start, order, density, EVENT_SHARE)

        def height(state: Point) -> float:
            return _height(event, state)

        states = states_near(point, order, density)
        radius, slope = states.extremum(height)
        spec, point_there = states_near(states.start, order, density).on_fine_mesh(radius)
        others = [(order - 1, density)]
        others += [(order, ratio * density) for ratio in other_lengths(self.meshes.problem, spec, radius)]
        radii = [states_near(states.start, *other).extremum(height)[0] for other in others]
        radius_error = sum(abs(math.log(radius / other)) for other in radii)
        return (spec, radius), Anchor(replace(point_there, pinned=True), slope, radius_error)


def _spot(separate: Sequence[Point], start: Point) -> float:
    """Smallest radius that the meshes before contact have, and its first edge."""
    return min(point.state.size for point in (*separate, start))


def _completed(separate: Sequence[Point], start: Point) -> tuple[list[Point], Point]:
    """The path before contact with all of its turning points, and its first edge."""
    *separate, start = complete_path([*separate, start])
    return separate, start


# Several problems are solved in turns where a parameter is varied.
@lru_cache(maxsize=2)
def followed_path(meshes: Meshes) -> FollowedPath:
    """Return the path over meshes of a problem, followed once for all of its events."""
    return FollowedPath(meshes)


def _height(event: str, point: Point) -> float:
    """Load or displacement, the lowest of which is the event."""
    return point.state.load if event == "pull_off" else point.state.displacement


# The search for the mesh of a cusp ends on the path that it is found on.
@lru_cache(maxsize=2)
def path_on(meshes: Meshes, spec: MeshSpec, size: float) -> PathEvents:
    """Return the events of the path on one mesh.

    Raises
    ------
    NotConverged
        If it cannot be traced there.
    """
    return PathEvents(traced(meshes.contact(spec, size)))
