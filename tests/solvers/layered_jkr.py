"""JKR contact with a layered half-space, independent of `fscm` and of `fem_reference`.

A rigid paraboloid adheres without friction to isotropic layers on a half-space; adhesion has no range (work of
adhesion w). Its Hankel transform is p(xi) = int_0^a phi(t) cos(xi t) dt, so the pressure vanishes beyond the contact
radius a. The surface compliance is 2 c(xi) / (E1* xi), with E1* of the surface layer and c = 1 for equal layers, and
the Abel transform of the displacement within the contact gives the Fredholm equation of the second kind

    phi(x) + (1/pi) int_{-a}^{a} k(x - t) phi(t) dt = (E1*/pi) (delta - s(x)),  k(s) = int_0^inf (c - 1) cos(xi s) dxi,

s(x) = d/dx int_0^x r f(r) / sqrt(x^2 - r^2) dr = x^2/R for the paraboloid f = r^2/(2 R). The load is
2 pi int_0^a phi, and the edge is in equilibrium at pi phi(a)^2 / (2 a E1*) = w with phi(a) < 0 (Sneddon 1965;
Maugis, Contact, Adhesion and Rupture, ch. 4).
SI units, or any others that agree; tension is negative.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev, legendre
from scipy.optimize import minimize_scalar

FAR_DECAY = 24.0  # exp(-2 FAR_DECAY) = 1e-21: c - 1 beyond xi = FAR_DECAY / thickness of the surface layer
PHASE = 4 * np.pi  # of cos(xi s) in one panel of at least 20 Gauss points: error below J_40(2 pi) = 1e-28
STEPS_PER_OCTAVE = 6  # of the scan; measured on 14 random and 25 regular stacks: minima are 3.3 octaves apart or more
SMALLEST = 0.01  # first contact radius, in units of the smallest length
LARGEST = 3.0  # last contact radius, in units of that at pull-off from the softest material
MINIMUM_WIDTH = 1e-7  # of ln a; the load is stationary, so 1e-14 of it


@dataclass(frozen=True)
class Medium:
    """Isotropic elastic material."""

    modulus: float
    poisson: float

    @property
    def plane_strain(self) -> float:
        """E / (1 - nu^2)."""
        return self.modulus / (1 - self.poisson**2)

    @property
    def shear(self) -> float:
        """E / (2 (1 + nu))."""
        return self.modulus / (2 * (1 + self.poisson))

    def decaying(self) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and tractions (without the factor xi) of the two fields that decay with depth.

        Rows are (W, V) of u_z = W J0(xi r), u_r = V J1(xi r), and (sigma_zz, tau) likewise. The fields are
        (1, 1) exp(-xi z) and (3 - 4 nu + xi z, xi z) exp(-xi z) at z = 0.
        """
        nu, mu = self.poisson, self.shear
        displacement = np.array([[1.0, 3 - 4 * nu], [1.0, 0.0]])
        traction = -2 * mu * np.array([[1.0, 2 - 2 * nu], [1.0, 1 - 2 * nu]])
        return displacement, traction


@dataclass(frozen=True)
class Stack:
    """Layers from the surface downwards as (modulus, Poisson's ratio, thickness), and the substrate below them."""

    layers: tuple[tuple[float, float, float], ...]
    substrate: tuple[float, float]

    @property
    def surface(self) -> Medium:
        """Material at the surface."""
        return Medium(*self.layers[0][:2])

    @property
    def media(self) -> list[Medium]:
        """All materials."""
        return [Medium(*layer[:2]) for layer in self.layers] + [Medium(*self.substrate)]

    def relative_compliance(self, xi: np.ndarray) -> np.ndarray:
        """c(xi), 1 for equal materials, by amplitudes of decaying and growing fields.

        Only exponentials that decay occur, so no thickness overflows. Lengths enter as xi * thickness.
        """
        xi = np.asarray(xi, dtype=float)
        displacement, traction = Medium(*self.substrate).decaying()
        stiffness = np.broadcast_to(traction @ np.linalg.inv(displacement), (*xi.shape, 2, 2))
        mirror_u, mirror_t = np.diag([-1.0, 1.0]), np.diag([1.0, -1.0])
        for modulus, poisson, thickness in reversed(self.layers):
            down_u, down_t = Medium(modulus, poisson).decaying()
            up_u, up_t = mirror_u @ down_u, mirror_t @ down_t
            reflected = -np.linalg.solve(up_t - stiffness @ up_u, down_t - stiffness @ down_u)
            depth = xi * thickness
            # Field 2 at depth z is field 2 plus xi z of field 1; the same holds for the mirrored fields.
            shift = np.exp(-depth)[..., None, None] * (np.eye(2) + depth[..., None, None] * np.array([[0, 1], [0, 0]]))
            reflected = shift @ reflected @ shift
            stiffness = (down_t + up_t @ reflected) @ np.linalg.inv(down_u + up_u @ reflected)
        compliance = np.linalg.inv(stiffness)[..., 0, 0]
        return -compliance * self.surface.plane_strain / 2


class CompressedKernel:
    """k(s) on 0 <= s <= `reach`: Chebyshev series on intervals [0, h], [h, 2 h], [2 h, 4 h], ...

    k is analytic within 2 h of the axis, so series of the degree 31 are right to 3e-13 of its largest value.
    """

    def __init__(self, stack: Stack, reach: float, points: int):
        self.h = stack.layers[0][2]
        octaves = max(0, int(np.ceil(np.log2(reach / self.h))))
        edges = self.h * np.concatenate([[0.0], 2.0 ** np.arange(octaves + 1)])
        nodes = np.cos(np.pi * (np.arange(2 * points) + 0.5) / (2 * points))
        to_series = np.linalg.inv(chebyshev.chebvander(nodes, 2 * points - 1))
        depth = sum(layer[2] for layer in stack.layers)
        moduli = [medium.plane_strain for medium in stack.media]
        farthest = max(depth, reach) * max(moduli) / min(moduli)
        octaves_of_xi = int(np.ceil(np.log2(FAR_DECAY / self.h * farthest))) + 4
        panels_of_xi = FAR_DECAY / self.h * np.concatenate([[0.0], 2.0 ** np.arange(-octaves_of_xi, 0.5, 0.5)])
        series = []
        for start, stop in pairwise(edges):
            xi, weight = gauss_panels(split(panels_of_xi, PHASE / stop), points + 8)
            amplitude = weight * (stack.relative_compliance(xi) - 1)
            s = (start + stop) / 2 + (stop - start) / 2 * nodes
            series.append(to_series @ np.array([np.cos(xi * distance) @ amplitude for distance in s]))
        self.series = np.array(series).T

    def __call__(self, s: np.ndarray) -> np.ndarray:
        """k(|s|)."""
        s = np.abs(s)
        exponent = np.frexp(s / self.h)[1]  # s < h 2^exponent
        interval = np.clip(exponent, 0, self.series.shape[1] - 1)
        stop = self.h * np.ldexp(1.0, interval)
        start = np.where(interval == 0, 0.0, stop / 2)
        local = (2 * s - start - stop) / (stop - start)
        return chebyshev.chebval(local, self.series[:, interval], tensor=False)


def gauss_panels(edges: np.ndarray, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre points and weights in all panels between `edges`."""
    x, w = legendre.leggauss(points)
    half = np.diff(edges)[:, None] / 2
    return (edges[:-1, None] + half * (1 + x)).ravel(), (half * w).ravel()


def split(edges: np.ndarray, width: float) -> np.ndarray:
    """Edges of the same panels, each cut into equal ones of at most `width`."""
    counts = np.ceil(np.diff(edges) / width).astype(int)
    cuts = [np.linspace(a, b, n + 1)[:-1] for (a, b), n in zip(pairwise(edges), counts, strict=True)]
    return np.append(np.concatenate(cuts), edges[-1])


@dataclass(frozen=True)
class Equilibrium:
    """One state of the JKR path."""

    contact_radius: float
    load: float
    displacement: float


class LayeredJKR:
    """JKR path of the paraboloid f(r) = r^2 / (2 R) on a stack.

    Parameters
    ----------
    stack
        Layers and substrate.
    work
        Work of adhesion.
    R
        Radius of the paraboloid.
    reach
        Largest contact radius.
    points
        Gauss points in each panel of the contact.
    """

    def __init__(self, stack: Stack, work: float, R: float, reach: float, points: int = 16):
        self.stack, self.work, self.R, self.reach, self.points = stack, work, R, reach, points

    @cached_property
    def kernel(self) -> CompressedKernel:
        return CompressedKernel(self.stack, 2 * self.reach, self.points)

    def abel_profile(self, x: np.ndarray) -> np.ndarray:
        """s(x) = d/dx int_0^x r f(r) / sqrt(x^2 - r^2) dr."""
        return x**2 / self.R

    def panels(self, a: float) -> np.ndarray:
        """Panels of [0, a], halved towards the edge down to half a thickness."""
        octaves = max(1, int(np.ceil(np.log2(2 * a / self.kernel.h))))
        return np.append(a * (1 - 2.0 ** -np.arange(octaves + 1.0)), a)

    def solutions(self, a: float) -> tuple[np.ndarray, np.ndarray]:
        """(int_0^a phi, phi(a)) in units of E1*/pi, for the displacement 1 and for the profile."""
        edges = self.panels(a)
        count, points = edges.size - 1, self.points
        x, weight = gauss_panels(edges, points)
        symmetric = np.concatenate([-edges[:0:-1], edges])
        inverse_vander = np.linalg.inv(legendre.legvander(legendre.leggauss(points)[0], points - 1))
        parity = (-1.0) ** np.arange(points)
        operator = np.empty((x.size + 1, x.size))
        for row, centre in enumerate(np.append(x, a)):
            t, w, starts, local = self.quadrature(centre, symmetric)
            terms = (w * self.kernel(centre - t))[:, None] * legendre.legvander(local, points - 1)
            moments = np.add.reduceat(terms, starts)
            # phi is even: the panels of [-a, 0] mirror those of [0, a].
            operator[row] = ((moments[count:] + parity * moments[count - 1 :: -1]) @ inverse_vander).ravel()
        operator /= np.pi
        right = np.column_stack([np.ones_like(x), self.abel_profile(x)])
        phi = np.linalg.solve(np.eye(x.size) + operator[:-1], right)
        edge = np.array([1.0, self.abel_profile(np.array(a))]) - operator[-1] @ phi
        return weight @ phi, edge

    def quadrature(self, centre: float, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Points, weights, first points of the panels, local coordinates; panels are cut to the distance of `centre`.

        No piece is longer than the larger of its distance from `centre` and h.
        """
        spans = self.kernel.h * 2.0 ** np.arange(np.ceil(np.log2(max(2 * edges[-1] / self.kernel.h, 1))) + 1)
        cuts = np.concatenate([centre - spans, [centre], centre + spans])
        cuts = np.union1d(edges, cuts[(cuts > edges[0]) & (cuts < edges[-1])])
        t, w = gauss_panels(cuts, self.points + 8)
        starts = np.searchsorted(cuts, edges)
        panel = np.repeat(np.arange(edges.size - 1), np.diff(starts) * (self.points + 8))
        local = (2 * t - edges[panel] - edges[panel + 1]) / (edges[panel + 1] - edges[panel])
        return t, w, starts[:-1] * (self.points + 8), local

    def state(self, a: float) -> Equilibrium:
        """Equilibrium with the contact radius a."""
        modulus = self.stack.surface.plane_strain
        total, edge = self.solutions(a)
        displacement = (edge[1] - np.sqrt(2 * np.pi * a * self.work / modulus)) / edge[0]
        return Equilibrium(a, float(2 * modulus * (displacement * total[0] - total[1])), float(displacement))

    def scan(self, steps_per_octave: int = STEPS_PER_OCTAVE) -> list[Equilibrium]:
        """States from far below the thinnest layer and every contact radius of a half-space up to `reach`."""
        lengths = [layer[2] for layer in self.stack.layers]
        lengths += [half_space_radius(medium, self.work, self.R) for medium in self.stack.media]
        octaves = np.log2(self.reach / (SMALLEST * min(lengths)))
        radii = self.reach * 2.0 ** -np.linspace(octaves, 0, int(np.ceil(octaves * steps_per_octave)) + 1)
        return [self.state(a) for a in radii]

    def minima(self, steps_per_octave: int = STEPS_PER_OCTAVE) -> list[Equilibrium]:
        """All local minima of the load over the contact radius, by increasing contact radius."""
        states = self.scan(steps_per_octave)
        return [
            self.refined(before.contact_radius, after.contact_radius)
            for before, middle, after in zip(states, states[1:], states[2:], strict=False)
            if middle.load <= min(before.load, after.load)
        ]

    def refined(self, low: float, high: float) -> Equilibrium:
        """The minimum of the load between two contact radii."""
        bounds = (np.log(low), np.log(high))
        result = minimize_scalar(
            lambda x: self.state(np.exp(x)).load, bounds=bounds, method="bounded", options={"xatol": MINIMUM_WIDTH}
        )
        return self.state(float(np.exp(result.x)))


def half_space_radius(medium: Medium, work: float, R: float) -> float:
    """Contact radius at pull-off from a half-space: a^3 = 9 pi w R^2 / (8 E*)."""
    return float(np.cbrt(9 * np.pi * work * R**2 / (8 * medium.plane_strain)))


def jkr(stack: Stack, work: float, R: float, points: int = 16) -> LayeredJKR:
    """The paraboloid on the stack, with contact radii up to `LARGEST` of that at pull-off from the softest medium."""
    reach = LARGEST * max(half_space_radius(medium, work, R) for medium in stack.media)
    return LayeredJKR(stack, work, R, reach, points)


@dataclass(frozen=True)
class Minimum:
    """A local minimum of the load, and by how much the load changes with the Gauss points."""

    contact_radius: float
    load: float
    error: float


def minima_with_error(stack: Stack, work: float, R: float) -> list[Minimum]:
    """All minima of the load; error: change of the load from 12 to 16 Gauss points at the same contact radius.

    The load is stationary there, so the error of the contact radius is of second order.
    """
    fine, coarse = jkr(stack, work, R), jkr(stack, work, R, points=12)
    return [
        Minimum(state.contact_radius, state.load, abs(coarse.state(state.contact_radius).load - state.load))
        for state in fine.minima()
    ]
