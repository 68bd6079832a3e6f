"""Force curves of the FSCM from series, with bounds and derivatives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fscm._typing import Array
from fscm.errors import OutsideAtlas
from fscm.interpolation.coordinates import BOX, LEAST_MU, MOST_MU
from fscm.interpolation.curve.limits import jkr_approach, jkr_contact, rigid_curve
from fscm.interpolation.curve.pieces import Numbers, States, load_scale, states_of
from fscm.interpolation.curve.series import part_of, position_basis, stored_curve

if TYPE_CHECKING:
    from fscm.interpolation.curve.sections import LoadValue, Sections

__all__ = ["ForceCurve", "force_curve"]

#: Shares of the points that are on the pieces, and the fewest points of a curve.
_SHARES, _FEWEST = {"approach": 1.0 / 3.0, "contact": 0.5, "compression": 1.0 / 6.0}, 24
#: Exponent with which the difference of two series at the place where their pieces meet is spread over the contact: it
#: is a twentieth at a sixth of the piece.
_SPREAD = 16
#: Imaginary step of a derivative, so small that its square is below rounding.
_STEP = 1e-30
#: Points of a curve at which its distance from a limit is known, and points between two of them.
_OF_LIMIT, _BETWEEN = 240, 8
#: Share of the distance of JKR in its bound: as for the atlas.
_SAFETY = 2.0


@dataclass(frozen=True)
class ForceCurve:
    """The equilibrium path from far separation into contact; arrays of shape (..., p), `...` that of n, k and mu.

    Attributes
    ----------
    displacement, load, contact_radius : ndarray
        In the units of `fscm.solve`.  The contact radius is that of the largest tension; zero before the surface
        reaches it.
    branch : ndarray of str
        "approach" up to where displacement control jumps in, "contact" from where it jumps out on, "unstable" between;
        without jumps the first two meet where contact begins.
    u_displacement, u_load : ndarray
        A state of the exact path is nearer to each point, in both coordinates.  See the page on the atlas.

    Examples
    --------
    >>> curve = force_curve(2, 0, 1.0)
    >>> bool(abs(curve.load.min() + 1.67066478) <= curve.u_load[curve.load.argmin()] < 1e-2)
    True
    """

    displacement: Array
    load: Array
    contact_radius: Array
    branch: NDArray[np.str_]
    u_displacement: Array
    u_load: Array
    _parameters: tuple[Array, Array, Array] = field(repr=False, compare=False)
    _units: Mapping[str, float] = field(
        default_factory=lambda: {"displacement": 1.0, "load": 1.0, "radius": 1.0}, repr=False, compare=False
    )

    def derivative(self, parameter: str) -> States:
        """Derivatives of displacement, load and contact radius by "n", "k" or "mu" at fixed places on the path.

        The derivatives are exact for the series.  Places are chosen such that curves of neighbours are alike; the
        derivative of the load at a given displacement, which does not depend on this choice, is that of `load_at`.

        Examples
        --------
        >>> force_curve(2, 0, 1.0).derivative("mu").load.shape
        (240,)
        """
        if parameter not in BOX:
            raise ValueError(f"parameter = {parameter!r} is unknown; it is one of {', '.join(BOX)}")
        n, k, mu = (
            x + (1j * _STEP if name == parameter else 0.0) for name, x in zip(BOX, self._parameters, strict=True)
        )
        states = _states(n, k, mu, self.displacement.shape[-1])
        units = (self._units["displacement"], self._units["load"], self._units["radius"])
        shape = self.displacement.shape
        return States(*((np.imag(x) / _STEP).reshape(shape) * unit for x, unit in zip(states, units, strict=True)))

    def load_at(self, displacement: ArrayLike, branch: str, by: str | None = None) -> LoadValue:
        """Loads that displacement control measures, or their derivatives; for one curve.

        Parameters
        ----------
        displacement : array_like
            Up to where the load is 12,000 units; any distance.
        branch : str
            "approach": before the jump-in, then in contact; "retreat": in contact down to the jump-out, then away.
        by : str, optional
            "n", "k" or "mu": the derivative of the load at fixed displacement, with a bound of nan.

        Examples
        --------
        >>> curve = force_curve(2, 0, 2.0)
        >>> curve.load_at([-3.0, -2.0], "approach").value.round(2).tolist()
        [-0.2, -1.57]
        """
        if self.displacement.ndim != 1:
            raise ValueError("load_at needs one curve: give n, k and mu as numbers, or take one curve after the other")
        return self._sections.load_at(displacement, branch, None if by is None else self.derivative(by))

    @property
    def jump_in(self) -> float | None:
        """Displacement of the jump-in of one curve; None without."""
        return self._sections.jump_in

    @property
    def jump_out(self) -> float | None:
        """Displacement of the jump-out of one curve; None without."""
        return self._sections.jump_out

    @cached_property
    def _sections(self) -> Sections:
        from fscm.interpolation.curve.sections import Sections

        columns = self.displacement, self.load, self.u_displacement, self.u_load
        z0, (n, _, mu) = self._units["displacement"], (float(x[0]) for x in self._parameters)
        return Sections.of(columns, bool((self.branch == "unstable").any()), (1.0 + mu) * z0, n, z0)

    def in_units(self, units: Mapping[str, float]) -> ForceCurve:
        """The curve in the units of a physical problem, ``problem.units``.

        Examples
        --------
        >>> import fscm
        >>> solid, punch = fscm.PowerLaw(E0=3e6, c0=1.0, k=0.0, nu=0.5), fscm.PowerPunch(n=2, Q=1e-6)
        >>> bead = fscm.Problem(solid, punch, fscm.LennardJones(work_of_adhesion=0.05, z0=0.4e-9))
        >>> curve = force_curve(bead.n, bead.k, bead.mu).in_units(bead.units)
        >>> bool(-3.2e-7 < curve.load.min() < -2.2e-7)
        True
        """
        displacement, load, radius = units["displacement"], units["load"], units["radius"]
        return replace(
            self,
            displacement=self.displacement * displacement,
            load=self.load * load,
            contact_radius=self.contact_radius * radius,
            u_displacement=self.u_displacement * displacement,
            u_load=self.u_load * load,
            _units={"displacement": displacement, "load": load, "radius": radius},
        )


def force_curve(n: ArrayLike, k: ArrayLike, mu: ArrayLike, *, points: int = 240) -> ForceCurve:
    """The force curve of a power-law punch, a power-law solid and the Lennard-Jones 9-3 law, from series.

    Parameters
    ----------
    n, k, mu : array_like of float
        Shape index, 1 to 6; gradient exponent, 0 to 0.8; Tabor number, above 0.  They are broadcast together.  For
        Tabor numbers above 10 the curve is that of JKR, below 0.01 that of 0.01, with bounds that cover the
        difference.
    points : int
        Number of points, at least 24.

    Returns
    -------
    ForceCurve
        From the central gap 10 + 5 mu to the load 12,000.

    Raises
    ------
    OutsideAtlas
        If n or k is outside its range.

    Examples
    --------
    >>> curves = force_curve(2, 0, [0.1, 1.0, 10.0])
    >>> curves.load.shape, curves.load.min(axis=1).round(2).tolist()
    ((3, 240), [-1.97, -1.67, -1.51])
    """
    parameters = [_checked(name, values) for name, values in (("n", n), ("k", k), ("mu", mu))]
    try:
        grids = np.broadcast_arrays(*parameters)
    except ValueError:
        shapes = ", ".join(str(values.shape) for values in parameters)
        raise ValueError(f"the shapes {shapes} of n, k and mu do not fit together") from None
    if points < _FEWEST:
        raise ValueError(f"points = {points} is outside [{_FEWEST}, inf): fewer do not show a curve")
    shape = (*grids[0].shape, points)
    flat = tuple(np.array(grid, dtype=float).ravel() for grid in grids)
    at = flat[0], flat[1], flat[2]
    states = _states(*at, points)
    u_displacement, u_load = _bounds(*at, states)
    return ForceCurve(
        displacement=states.displacement.reshape(shape),
        load=states.load.reshape(shape),
        contact_radius=states.contact_radius.reshape(shape),
        branch=_branches(states).reshape(shape),
        u_displacement=u_displacement.reshape(shape),
        u_load=u_load.reshape(shape),
        _parameters=at,
    )


def _checked(name: str, values: ArrayLike) -> Array:
    array = np.asarray(values)
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name} = {values!r} is not a real number, nor an array of them")
    if name == "mu":
        wrong = array[~((array > 0.0) & np.isfinite(array))]
        if wrong.size:
            raise ValueError(f"mu = {wrong.flat[0]:g} is outside (0, inf): a Tabor number is positive")
        return array
    low, high = BOX[name]
    outside = array[~((array >= low) & (array <= high))]
    if outside.size:
        raise OutsideAtlas(
            f"{name} = {outside.flat[0]:g} is outside [{low:g}, {high:g}], the range of the force curves; "
            "fscm.trace has a wider one"
        )
    return array


def _counts(points: int) -> dict[str, int]:
    """Points of each piece; where two pieces meet, one of two is not counted."""
    approach, compression = round(_SHARES["approach"] * points), round(_SHARES["compression"] * points) + 1
    return {"approach": approach, "contact": points - approach - compression + 2, "compression": compression}


def _states(n: Numbers, k: Numbers, mu: Numbers, points: int) -> States:
    """States at all points, shape (m, p), by the series and the limits."""
    is_limit = np.real(mu) > MOST_MU
    if not is_limit.any():
        return _of_series(n, k, mu, points)
    if is_limit.all():
        return _of_jkr(n, k, mu, points)
    kind = complex if any(np.iscomplexobj(x) for x in (n, k, mu)) else float
    whole = np.empty((3, len(mu), points), kind)
    for mask, function in ((is_limit, _of_jkr), (~is_limit, _of_series)):
        whole[:, mask] = function(n[mask], k[mask], mu[mask], points)
    return States(whole[0], whole[1], whole[2])


def _joined(approach: States, contact: States, compression: States) -> States:
    """The pieces as one path; the first points of the second and the third one are the last ones before."""
    parts = zip(approach, contact, compression, strict=True)
    displacement, load, radius = (np.concatenate([a, b[:, 1:], c[:, 1:]], axis=-1) for a, b, c in parts)
    return States(displacement, load, radius)


def _of_series(n: Numbers, k: Numbers, mu: Numbers, points: int) -> States:
    # Contacts that are stiffer are as good as rigid; the bound has the difference.
    mu = np.where(np.real(mu) < LEAST_MU, LEAST_MU, mu)
    components, parts = stored_curve().components(n, k, mu), []
    for piece, count in _counts(points).items():
        position, terms = position_basis(count, components[piece].shape[-1] - 1)
        parts.append(states_of(piece, n[:, None], mu[:, None], position, components[piece] @ terms))
        if piece == "contact":
            share = 0.5 * (position + 1.0)
    approach, contact, compression = parts
    begin, end = (1.0 - share) ** _SPREAD, share**_SPREAD
    displacement, load = (
        y + begin * (x[:, -1:] - y[:, :1]) + end * (z[:, :1] - y[:, -1:])
        for x, y, z in zip(approach[:2], contact[:2], compression[:2], strict=True)
    )
    return _joined(approach, States(displacement, load, contact.contact_radius), compression)


def _of_jkr(n: Numbers, k: Numbers, mu: Numbers, points: int) -> States:
    at = n[:, None], k[:, None], mu[:, None]
    approach, contact, compression = (np.linspace(-1.0, 1.0, count) for count in _counts(points).values())
    return _joined(
        jkr_approach(*at, approach),
        # The last one before contact and the first one in contact differ.
        jkr_contact(*at, np.concatenate([contact[:1], contact[:-1]]), False),
        jkr_contact(*at, compression, True),
    )


def _branches(states: States) -> NDArray[np.str_]:
    """The branch of each point, shape (m, p)."""
    falls = np.diff(states.displacement, axis=-1) < 0.0
    count = falls.shape[-1] + 1
    middle = _counts(count)["approach"]
    number = np.arange(count)
    folds = np.asarray(falls.any(axis=-1))
    first = np.where(folds, falls.argmax(axis=-1), middle - 1)[:, None]
    last = np.where(folds, count - 1 - falls[:, ::-1].argmax(axis=-1), middle)[:, None]
    return np.where(number <= first, "approach", np.where(number >= last, "contact", "unstable"))


def _bounds(n: Array, k: Array, mu: Array, states: States) -> tuple[Array, Array]:
    """Bounds of displacement and load, shape (m, p)."""
    points = states.load.shape[-1]
    relative = _of_stored(n, k, np.clip(mu, LEAST_MU, MOST_MU), points)
    for i in np.flatnonzero(mu < LEAST_MU):
        relative[:, i] += _at_points(_distance_of_rigid(float(n[i]), float(k[i])), points)
    for i in np.flatnonzero(mu > MOST_MU):
        # Beyond pull-off the distance falls at least like 1/mu; a jump-in stays away from that of the limit.
        falling = np.arange(points) >= int(np.argmin(states.load[i]))
        relative[:, i] = _at_points(_distance_of_jkr(float(n[i]), float(k[i])), points) * np.where(
            falling, MOST_MU / mu[i], 1.0
        )
    units = 1.0 + mu[:, None] + np.abs(states.displacement), load_scale(n[:, None], mu[:, None], states.load)
    return relative[0] * units[0], relative[1] * units[1]


def _of_stored(n: Array, k: Array, mu: Array, points: int) -> Array:
    """Bounds of displacement and load by the series in their units, shape (2, m, p)."""
    return stored_curve().bound(n, k, mu, _parts(points))[:2]


@cache
def _parts(points: int) -> NDArray[np.int_]:
    parts = [part_of(piece, position_basis(count, 1)[0]) for piece, count in _counts(points).items()]
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:])])


def _at_points(distances: Array, points: int) -> Array:
    """Distances at so many points from those at `_OF_LIMIT` points."""
    numbers = []
    start = 0
    for few, many in zip(_counts(_OF_LIMIT).values(), _counts(points).values(), strict=True):
        numbers.append(start + np.linspace(0.0, few - 1.0, many)[min(start, 1) :])
        start += few - 1
    at = np.concatenate(numbers)
    return np.array([np.interp(at, np.arange(_OF_LIMIT), row) for row in distances])


@lru_cache(maxsize=64)
def _distance_of_jkr(n: float, k: float) -> Array:
    """Distance of points of JKR from the series at the end of their range, and the bound of these, shape (2, p)."""
    at = np.array([n]), np.array([k]), np.array([MOST_MU])
    apart, nearest = _distances(_of_jkr(*at, _OF_LIMIT), _of_series(*at, _OF_LIMIT), *at)
    return _SAFETY * apart + _of_stored(*at, _OF_LIMIT)[:, 0, np.minimum(nearest.astype(int) + 1, _OF_LIMIT - 1)]


@lru_cache(maxsize=64)
def _distance_of_rigid(n: float, k: float) -> Array:
    """Distance of points of the series at the beginning of their range from rigid bodies, shape (2, p)."""
    at = np.array([n]), np.array([k]), np.array([LEAST_MU])
    rigid = States(*(x[None] for x in rigid_curve(n, _OF_LIMIT)))
    return _distances(_of_series(*at, _OF_LIMIT), rigid, *at)[0]


def _distances(points: States, curve: States, n: Array, k: Array, mu: Array) -> tuple[Array, Array]:
    """Distances of points from a curve in the units of bounds, shape (2, p), and the nearest places on the curve.

    Points before contact are compared with the curve before contact, and points in contact with that in contact.
    """
    count = curve.load.shape[1]
    places = np.linspace(0.0, count - 1.0, _BETWEEN * count)
    dense = [np.interp(places, np.arange(count), x[0]) for x in curve]
    units = 1.0 + mu + np.abs(points.displacement[0]), load_scale(n, mu, points.load[0])
    apart = [
        np.abs(x[0][:, None] - y[None, :]) / unit[:, None] for x, y, unit in zip(points, dense, units, strict=False)
    ]
    before = np.arange(len(points.load[0])) < _counts(len(points.load[0]))["approach"]
    other = before[:, None] != (dense[2] <= 0.0)[None, :]
    both = np.where(other, np.inf, np.maximum(*apart))
    nearest = both.argmin(axis=1)
    # What is between two curves is as near in both coordinates as the farther one.
    return np.tile(both[np.arange(len(nearest)), nearest], (2, 1)), places[nearest]
