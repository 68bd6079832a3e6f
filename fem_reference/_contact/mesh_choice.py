"""Choice of the mesh: three densities an accuracy, and an edge as fine as the computed gap needs.

The first width of the contact edge is the length over which the surface law and the solid balance; the path traced
on that mesh shows how wide the edge is, and the mesh is made again until it is fine enough.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache, partial

from fem_reference._contact.carried_path import carried_path, found_on_carried
from fem_reference._contact.contact import Contact
from fem_reference._contact.cusp import slowest_sample
from fem_reference._contact.edge_search import MESHES, SEARCHED, WIDTH_SHARE, EdgeSearch, state_at
from fem_reference._contact.events import CUSP, JUMP_IN, LANDING, PathEvents, beyond_pull_off
from fem_reference._contact.mesh_lengths import balance_length, check_width, kinks_within, mesh_spec
from fem_reference._contact.path import EDGE_RISE, Point, edge_width, point_at
from fem_reference._contact.tracing import first_in_contact, traced, traced_to_fold
from fem_reference._elastic.compliance import compliance_for, is_scaling
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import Level, finer_levels
from fem_reference.errors import NotConverged
from fem_reference.problem import Problem
from fem_reference.punch import check_without_asperities, radius_at_height

__all__ = ["MeshChoice", "chosen"]

FAR_SHARE = 0.5
"""Share of the density far beyond the edge, where contact begins on a spot much smaller than the punch and the tension
falls within an element otherwise: on the meshes of "quick" the path of n = 6.2, k = 0.53, mu = 2.9 stops there with 1,
and with 0.5 it is that of 0.3 to 1e-6 (measured)."""

SMALL_SPOT = 0.25
"""Smallest radius of the contact, relative to that where the punch rises by `EDGE_RISE`, below which it is small."""

FAILURES = 3
"""Meshes in a row on which a path cannot be traced, after which meshes of a finer accuracy are tried: a narrower edge
does not help then."""

NARROWER = 0.25
"""Ratio of edge widths from one mesh to the next where the width is not known."""

LOWEST, HIGHEST = 1e-8, 1e4
"""Heights of a punch, in lengths of the law, between which it may have no asperity: below, it is flat to the law, and
above, the tension is 1e-12 of its peak."""

SEARCH_DEGREES = 2
"""Degrees by which the elements of the search are lower where no mesh of it is used again: a third of the time."""

MOVES = 2
"""Times that the edge of a mesh follows the event of the path on it; then the event is searched for with a mesh for
each radius."""

FARTHEST = 10.0
"""Radius of the event, in radii of the edge of the first mesh, from which on a mesh for each radius is tried at once.
Measured under cones at mu = 3: at most 8.9 on the twelve solids whose path one mesh carries, 11 to 27 on the others, if
their first mesh carries a path at all."""

MOST_CARRIED = 120
"""Largest number of meshes that carry a path: 40 are usual where the contact grows to a hundred times the radius at
which it begins."""

REFINEMENTS = 8
"""Largest number of meshes tried to find the width of the edge."""


@dataclass(frozen=True, slots=True)
class MeshChoice:
    """The mesh for a problem at an accuracy.

    Parameters
    ----------
    problem : Problem
    level : Level
        Order and densities of the meshes.
    event : str, optional
        As for `fem_reference._contact.events.PathEvents`.
    near : Point, optional
        A state near that event on another mesh, where no mesh carries the whole path.
    """

    problem: Problem
    level: Level
    event: str = ""
    near: Point | None = None

    def contact(self, spec: MeshSpec, size: float) -> Contact:
        """Discretise the problem on a mesh with its edge at the radius `size`."""
        solid, punch, law = self.problem.solid, self.problem.punch, self.problem.law
        return Contact(punch, law, compliance_for(solid.modulus, solid.nu, spec, size))

    def traced(self, spec: MeshSpec, size: float) -> PathEvents:
        """The path on that mesh, traced once however many quantities are read from it.

        Raises
        ------
        NotConverged
            If it cannot be traced there.
        """
        path = _traced(self, spec, size)
        if isinstance(path, str):
            raise NotConverged(path)
        return path

    def spec(
        self, width: float, size: float, smallest: float, far_share: float = 1.0, apex: float = math.inf
    ) -> MeshSpec:
        """Mesh for an edge of that relative width, at the coarsest density."""
        return mesh_spec(self.problem, self.level, width, size, smallest, far_share, apex)

    @property
    def scaling(self) -> bool:
        """Whether the compliance of one size is that of every size, but for a factor."""
        return is_scaling(self.problem.solid.modulus, self.problem.solid.nu, kinks_within(self.problem))

    def adapted(
        self, events: tuple[str, ...], start: tuple[MeshSpec, float] | None = None, brief: bool = False
    ) -> tuple[MeshChoice, MeshSpec, float]:
        """Mesh whose edge width (and, if the solid does not scale, size) fits the computed gap.

        The path is traced on one mesh after the other until the edge of the event is known.

        Parameters
        ----------
        events : tuple of str
            Events that are needed.  If the solid does not scale, the mesh is fine at the edge of the first.
        start : tuple, optional
            The mesh and size of a similar problem, to begin with.
        brief : bool
            Raise where a path cannot be traced, or an event up to the pull-off is needed, which is far from the edge of
            the mesh.

        Returns
        -------
        choice : MeshChoice
            This one, or one whose event is at the edge of the mesh.
        spec : MeshSpec
            At the coarsest density of the accuracy.
        size : float
            Radius of the edge of the mesh, in the length unit of the input.

        Raises
        ------
        NoSuchEvent
            If the solid does not scale and the path has no such point.
        NotConverged
            If the path cannot be traced, or the edge is narrower than the mesh can resolve.
        """
        scaling = self.scaling
        punch, law = self.problem.punch, self.problem.law
        first = smallest = radius_at_height(punch, EDGE_RISE * law.length)
        # The folds merge before there is a sharp edge: the mesh of a solid that scales is fine at this radius, too.
        size = first if events == (CUSP,) and not scaling else 2.0 * radius_at_height(punch, law.length)
        balance = balance_length(self.problem, size)
        check_width(0.5 * balance / size)
        spec = self.spec(0.5 * balance / size, size, smallest)
        if start is not None:
            spec, size = replace(start[0], density=self.level.densities[0]), start[1]
        failures, moves, far_share, apex = 0, 0, spec.far_share, math.inf
        # Width and radius of an edge need fewer digits than an event; a mesh that scales is used again, as it is.
        degree = spec.order if scaling or events == (CUSP,) else spec.order - SEARCH_DEGREES
        for _ in range(REFINEMENTS):
            try:
                path = self.traced(replace(spec, order=degree), size)
            except NotConverged:
                if brief:
                    raise
                if degree < spec.order:
                    degree = spec.order
                    continue
                # An under-resolved edge is pinned to the elements; or contact begins on a spot, which is as small as
                # the solid and the law allow, far from elements that lose the rest of the punch.
                failures += 1
                if scaling:
                    smallest, far_share = min(smallest, balance), FAR_SHARE * far_share
                else:
                    apex = balance
                other = self.spec(NARROWER * spec.edge_width, size, smallest, far_share, apex)
                if other == spec or failures == FAILURES:
                    raise
                spec = other
                continue
            failures = 0
            points = path.samples
            if events == (CUSP,):
                # The folds merge before the edge is as sharp as at the pull-off.
                points = points[: slowest_sample(points) + 2]
            elif not any(beyond_pull_off(event) for event in events):
                # Beyond the pull-off the edge is sharper relative to its radius, but that part is not needed.
                deepest = min(range(len(points)), key=lambda i: points[i].state.load)
                farthest = points[deepest].edge_radius if points[deepest].branch.touching else 0.0
                if brief and events[0] != JUMP_IN and farthest > FARTHEST * size:
                    raise NotConverged(
                        f"the pull-off is at {farthest / size:.1f} times the radius where the mesh is fine"
                    )
                points = points[: deepest + 2]
            widths = [edge_width(point) for point in points if point.branch.touching]
            if scaling:
                # Contact may begin on a spot much smaller than the punch, and the mesh shrinks with it.
                smallest = min(smallest, *(point.state.size for point in points))
                if smallest < SMALL_SPOT * first:
                    far_share = min(far_share, FAR_SHARE)
            narrowest = min(widths, default=1.0)
            # The gap falls at the edge of a mesh that is too coarse to tell the width.
            width = WIDTH_SHARE * narrowest if narrowest > 0.0 else NARROWER * spec.edge_width
            check_width(width)
            needed = self.spec(width, size, smallest, far_share, apex)
            resolved = needed.edge_width >= spec.edge_width and needed.extent <= spec.extent
            if resolved and far_share >= spec.far_share:
                if scaling:
                    return self, spec, size
                if events == (CUSP,):
                    return self, spec, size
                try:
                    point = path.at(events[0])
                except NotConverged:
                    # Elements that are longer than the edge is wide make more turning points than can be told apart.
                    if events[0] != "pull_off":
                        raise
                    point, moves = min(points, key=lambda sample: sample.state.load), MOVES
                if not point.branch.touching or abs(point.edge_radius / size - 1.0) <= 0.5 * spec.edge_width:
                    return self, spec, size
                if moves == MOVES and events[0] in SEARCHED:
                    level = path.jump_in.state.displacement if events[0] == LANDING else 0.0
                    lower = spec.order - SEARCH_DEGREES
                    search = EdgeSearch(self, events[0], path.samples, spec.edge_width, smallest, lower, level, apex)
                    return replace(self, event=events[0]), *search.found(point.edge_radius)
                moves += 1
                size = point.edge_radius
            spec = self.spec(min(needed.edge_width, spec.edge_width), size, smallest, far_share, apex)
        raise NotConverged(
            "the width of the contact edge was not found; the edge is narrower than the mesh can resolve"
        )

    def carried(self, event: str) -> tuple[MeshChoice, MeshSpec, float]:
        """Mesh for an event of a solid that does not scale, where no mesh carries the path to it.

        Parameters
        ----------
        event : str
            `JUMP_IN`, or one of `fem_reference._contact.edge_search.SEARCHED` but a landing.

        Returns
        -------
        choice, spec, size
            As `adapted` returns them, of a choice that knows this event alone.

        Raises
        ------
        NotConverged
            If a state on the way is not found, or the path in contact has no such point.
        """
        return self._before_contact() if event == JUMP_IN else self._fine_at(event)

    def _before_contact(self) -> tuple[MeshChoice, MeshSpec, float]:
        """Mesh for a jump into contact, which needs the path up to its fold only."""
        spec, size, _ = self._first_mesh()
        choice = replace(self, event=JUMP_IN)
        choice.traced(spec, size)
        return choice, spec, size

    def _fine_at(self, event: str) -> tuple[MeshChoice, MeshSpec, float]:
        """Mesh that is fine at an event in contact, on a path of a mesh for each radius."""
        points = _carried_path(self)
        known = {point.edge_radius: point for point in points}
        search = replace(self._search(points), event=event, known=known, most=MESHES + len(known))
        spec, radius = found_on_carried(search, points, self.level.order)
        return replace(self, event=event, near=search.known[radius]), spec, radius

    def _search(self, samples: Sequence[Point]) -> EdgeSearch:
        """Solver on a mesh for each radius, from states that are known."""
        spec, size, smallest = self._first_mesh()
        lower, apex = spec.order - SEARCH_DEGREES, balance_length(self.problem, size)
        return EdgeSearch(self, "", samples, spec.edge_width, smallest, lower, apex=apex)

    def _first_mesh(self) -> tuple[MeshSpec, float, float]:
        """Mesh on which a path begins, its size, and the radius that tells its extent."""
        law, punch = self.problem.law, self.problem.punch
        size, smallest = 2.0 * radius_at_height(punch, law.length), radius_at_height(punch, EDGE_RISE * law.length)
        balance = balance_length(self.problem, size)
        return self.spec(0.5 * balance / size, size, smallest, apex=balance), size, smallest


def chosen(
    problem: Problem,
    events: tuple[str, ...],
    accuracy: float | str,
    usable: Callable[[MeshChoice, MeshSpec, float], object] | None = None,
    start: tuple[MeshSpec, float] | None = None,
) -> tuple[MeshChoice, MeshSpec, float]:
    """Choose the coarsest meshes, from those of an accuracy on, on which the path of a problem can be traced.

    Under a flat punch contact begins on a spot so much smaller than the punch that coarse meshes lose the rim.

    Parameters
    ----------
    problem : Problem
    events : tuple of str
        As for `MeshChoice.adapted`.
    accuracy : float or str
        As for `fem_reference.accuracy.level_for`.
    usable : callable, optional
        Called with the result; if it raises NotConverged, other meshes are tried.
    start : tuple, optional
        As for `MeshChoice.adapted`.

    Returns
    -------
    choice : MeshChoice
    spec, size
        As `MeshChoice.adapted` or `MeshChoice.carried` returns them.

    Raises
    ------
    ValueError
        For an unknown accuracy, or for an object that is not a Problem.
    NoSuchEvent
        As `MeshChoice.adapted`.
    NotConverged
        If the path cannot be traced on the finest meshes either, or is not known to end: on a punch with asperities.
    """
    if not isinstance(problem, Problem):
        raise ValueError(f"problem = {problem!r} is not a Problem; make one of a solid, a punch and a surface law")
    length = problem.law.length
    check_without_asperities(problem.punch, LOWEST * length, HIGHEST * length)

    def used(meshes: tuple[MeshChoice, MeshSpec, float]) -> tuple[MeshChoice, MeshSpec, float]:
        if usable is not None:
            usable(*meshes)
        return meshes

    choices = [MeshChoice(problem, level) for level in finer_levels(accuracy)]
    *others, last = [route for choice in choices for route in _routes(choice, events, start)]
    for route in others:
        with suppress(NotConverged):
            return used(route())
    return used(last())


def _routes(
    choice: MeshChoice, events: tuple[str, ...], start: tuple[MeshSpec, float] | None
) -> list[Callable[[], tuple[MeshChoice, MeshSpec, float]]]:
    """Ways to a mesh of one level: one mesh that carries the path; if the solid does not scale, one for each radius.

    The second is tried as soon as the first meets a difficulty: of the eight cones at mu = 3 that met one, six had no
    path on other meshes either, and the search for those of the other two took as long as all the rest.
    """
    one: Callable[..., tuple[MeshChoice, MeshSpec, float]] = partial(choice.adapted, events, start)
    # A landing is at the displacement of another event, which another mesh resolves.
    if choice.scaling or LANDING in events or events[0] not in (*SEARCHED, JUMP_IN):
        return [one]
    return [partial(one, brief=True), partial(choice.carried, events[0]), one]


# The paths of one problem: three densities and the search for the width, on the meshes of two kinds of events.
@lru_cache(maxsize=12)
def _traced(choice: MeshChoice, spec: MeshSpec, size: float) -> PathEvents | str:
    """The path, or why it cannot be traced: the next quantity would try it again."""
    try:
        contact = choice.contact(spec, size)
        if choice.event == JUMP_IN:
            return PathEvents(traced_to_fold(contact), JUMP_IN, whole=False)
        if choice.near is not None:
            return PathEvents([state_at(contact, size, [choice.near])], choice.event, whole=False)
        return PathEvents(tuple(traced(contact)), choice.event)
    except NotConverged as reason:
        return str(reason)


# Both jumps and the pull-off are on one of them.
@lru_cache(maxsize=2)
def _carried_path(choice: MeshChoice) -> tuple[Point, ...]:
    spec, size, _ = choice._first_mesh()
    first = first_in_contact(choice.contact(replace(spec, order=spec.order - SEARCH_DEGREES), size))
    # The solver begins at the edge of the first mesh, where it is fine.
    samples = [point_at(first, size)]
    return carried_path(replace(choice._search(samples), most=MOST_CARRIED), first.edge_radius, size)
