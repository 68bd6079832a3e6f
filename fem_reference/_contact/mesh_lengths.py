"""Lengths of a mesh: the edge, the layer under the surface, the extent, from the problem and the width of the edge."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from fem_reference._contact.bodies import are_one_power_law, plane_strain_modulus, stiffness_at
from fem_reference._elastic.depth_scales import depth_scales
from fem_reference._elastic.exterior import exterior_error
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._wells import scale_of_energy
from fem_reference.accuracy import Level
from fem_reference.errors import Failure, NotConverged
from fem_reference.problem import Problem
from fem_reference.punch import Punch, kinks_of, radius_at_height
from fem_reference.solid import Solid

__all__ = [
    "EDGE_PER_BALANCE",
    "EDGE_RISE",
    "FORCE_HEIGHT",
    "KINK_HEIGHT",
    "WIDEST",
    "balance_length",
    "check_width",
    "expected_spot",
    "extent_for",
    "kinks_within",
    "mesh_spec",
    "scales",
    "spot_length",
]

#: Gap at the node s = 1 above the central gap before contact, in lengths of the law: small, so that the edge is the
#: parameter before any pull-off (a flat punch, n = 5 and more, pulls off 0.1 z0 below the gap of peak tension).
EDGE_RISE = 0.05

#: Radial length resolved at r = 0, relative to the edge radius: a cone then has its pull-off force to 3e-10.
APEX_WIDTH = 0.05

#: The same under a pointed punch, whose pressure is singular at the tip: with 0.05 the gap there is right to 1e-2, with
#: this to 2e-5 (measured on the finest mesh of "quick" under cones at mu = 1.5 ... 3), for a tenth more of the time.
POINTED_APEX_WIDTH = 5e-5

#: Ratio of the curvatures of a punch at `APEX_WIDTH` and at the edge beyond which it is pointed.
POINTED = 2.0

#: Smallest radial length resolved at r = 0, relative to the edge radius.
SMALLEST_APEX = 1e-8

#: Depth resolved under the surface relative to the edge width, times min(1, 5 k): the first layer's error is linear in
#: its thickness for 0 < k < 0.2, where z^(1-k) and z are hard to tell apart.
LAYER_DEPTH = 0.02

#: Polynomials in k of the spot on which contact begins (`expected_spot`), fitted to 405 problems of n from 1 to 8, k up
#: to 0.85 and mu from 0.05 to 10 under the 9-3 law: within 4 % of half of them, 15 % of nine tenths, and 55 % of all.
SPOT_SHARE, SPOT_POWER = (0.563, 0.707, -1.246), (1.301, -0.892, 0.148)

#: Relative width of an edge: the smallest that is meshed (it costs an element for each factor of two), and the largest,
#: which resolves a surface without one.
NARROWEST, WIDEST = 1e-8, 0.25

#: The smallest of a mesh that carries a whole path: it extends far beyond the spot on which contact begins.
NARROWEST_OF_ONE_MESH = 1e-6

#: Ratio of the width of an edge to its length of balance (measured at the pull-off at mu = 160 and 1000, k = 0), and
#: share of it that is resolved.
EDGE_PER_BALANCE, WIDTH_SHARE = 2.2, 0.18

#: Ratio of the radii at which the energies of a contact are compared.
RADIUS_STEP = 1.1

#: Height of the punch, in lengths of the law, at the end of the mesh, for a tension that falls as H^-3 or faster (a
#: power 3/m of it for a slower H^-m): beyond it the traction enters P by a quadrature to infinity, and its displacement
#: (below 1e-8 z0 even for a cone) is dropped.
FAR_HEIGHT = 1e4

#: The same for a mesh of the pull-off force alone: a displacement that is the same in all of the contact does not
#: change the least load (measured at n = 1: by 2e-10 of it at mu = 0.05, and by 5e-11 and less from mu = 0.3 on).
FORCE_HEIGHT = 1e3

#: Height, in lengths of the law, below which the kinks of a punch are mesh lines: the traction beyond is 1e-5 of a
#: load, and a kink inside an element leaves 1e-3 of that.
KINK_HEIGHT = 300.0

#: Largest number of kinks in reach of the law; each costs four columns of elements.
MOST_KINKS = 60

#: Of a mesh, in units of its edge radius. It costs an element for each factor of two.
SMALLEST_EXTENT, LARGEST_EXTENT = 50.0, 1e8

#: Bound of the relative error of the displacement from the power law that the exterior takes: half of the accuracy
#: "default", for all accuracies, because it falls with the square of the extent.
EXTERIOR_ERROR = 5e-8

#: Steps to the length of balance: each leaves (1 + k) / 2 of the logarithm, 1e-8 of it at k = 0.9.
BALANCE_STEPS = 400

#: Relative error of the displacement under a tension of the length l, in (l/R)^3 or (l/R)^2 a/R, from the part beyond
#: the extent R (measured on meshes of 64 to 1024 for l = 1.8 to 180 a: up to 0.25, and 0.05 to 0.15 where it is small).
TENSION_SHARE = 0.3

#: Octaves of lengths below the extent in which that of the surface tension is searched for: below, the part of the
#: exterior is less than the rounding.
OCTAVES_OF_TENSION = 50

#: Depth, relative to the one resolved under the surface, from which on changes of the modulus are searched for.
FINEST_SCALE = 1e-3


def mesh_spec(
    problem: Problem,
    level: Level,
    width: float,
    size: float,
    smallest: float,
    far_share: float = 1.0,
    apex: float = math.inf,
) -> MeshSpec:
    """Return the mesh for an edge of a relative width; lengths are rounded so that similar problems share a mesh.

    Parameters
    ----------
    problem : Problem
    level : Level
    width : float
        Of the edge, relative to its radius.
    size : float
        Radius of the edge of the mesh.
    smallest : float
        Radius of the edge where the mesh still ends where the punch is `FAR_HEIGHT` high.
    far_share : float
        As for `fem_reference._elastic.mesh.MeshSpec`.
    apex : float
        Radius of the spot on which contact begins, if it is so small that the apex has to be finer for it.
    """
    solids = problem.solids
    width = 2.0 ** math.floor(math.log2(min(max(width, NARROWEST), WIDEST)))
    depth = min(_layer_depth(solid, width, size) for solid in solids)
    extent = extent_for(problem, smallest)
    while max(_far_error(solid, extent, size) for solid in solids) > EXTERIOR_ERROR and extent < LARGEST_EXTENT:
        extent *= 2.0
    scales, *of_punch = [
        depth_scales(solid, FINEST_SCALE * depth * size, extent * size).scaled(size) for solid in solids
    ]
    density, order = level.density, level.order
    kinks = tuple(r / size for r in kinks_within(problem))
    apex = max(apex / size, SMALLEST_APEX)
    if math.isfinite(apex):
        # Meshes at neighbouring radii on a power law, or of similar problems, share a compliance.
        apex = 2.0 ** math.floor(math.log2(apex))
    apex_width = min(_apex_width(problem.punch, size), apex)
    punch_scales = of_punch[0] if of_punch else None
    return MeshSpec(width, depth, extent, density, order, apex_width, scales, far_share, kinks, punch_scales)


def extent_for(problem: Problem, radius: float, height: float = FAR_HEIGHT) -> float:
    """Return how far a mesh extends, relative to the radius of the edge: to a height of the punch."""
    law = problem.law
    C, m = law.decay
    height = height ** max(1.0, 3.0 / m) if C != 0.0 else height
    far = radius_at_height(problem.punch, height * law.z0)
    return float(2.0 ** math.ceil(math.log2(min(max(far / radius, SMALLEST_EXTENT), LARGEST_EXTENT))))


def _layer_depth(solid: Solid, width: float, size: float) -> float:
    """Depth to resolve under the surface of a solid."""
    k = solid.surface_exponent
    depth = LAYER_DEPTH * width * min(1.0, 5.0 * k) if k > 0 else 0.3 * width
    return min(depth, 0.2 * solid.surface_depth / size)


def _far_error(solid: Solid, extent: float, size: float) -> float:
    """Relative error of the displacement from what is taken for the solid and its surface beyond the mesh.

    The tension there is that of the field of a load in the centre.  It moves the contact by P l / R^2, and what is left
    out is smaller by the length l of the tension over the extent R; the displacement itself is P / a or P / l.
    """
    error = exterior_error(solid.in_lengths(size), extent)
    reach = _tension_length(solid, extent * size) / (extent * size)
    return error + TENSION_SHARE * reach**2 * max(reach, 1.0 / extent)


def _tension_length(solid: Solid, longest: float) -> float:
    """Longest wave length, up to one, whose stiffness by the surface tension exceeds that of the solid."""
    tension = solid.surface_tension
    if not tension:
        return 0.0
    lengths = longest * 2.0 ** -np.arange(0.0, OCTAVES_OF_TENSION, 0.25)
    tense = lengths[np.asarray(solid.modulus(lengths)) * lengths <= 2.0 * tension]
    return float(tense[0]) if tense.size else 0.0


def _apex_width(punch: Punch, size: float) -> float:
    """Radial length to resolve at r = 0 under a punch of that shape, relative to the edge radius."""
    inner, outer = punch.slope(np.array([APEX_WIDTH * size, size]))
    return POINTED_APEX_WIDTH if inner > POINTED * APEX_WIDTH * outer else APEX_WIDTH


def kinks_within(problem: Problem) -> tuple[float, ...]:
    """Radii of the kinks of the punch within the reach of the law.

    Raises
    ------
    NotConverged
        If they are more than a mesh can follow.

    Examples
    --------
    >>> from fem_reference import LennardJones, MeasuredPunch, PowerLaw
    >>> profile = MeasuredPunch(radii=(0.0, 1.0, 100.0), heights=(0.0, 1.0, 2e4))
    >>> kinks_within(Problem(PowerLaw(E0=1.0, c0=1.0, k=0.0, nu=0.3), profile, LennardJones(1.0, 1.0)))
    (1.0,)
    """
    kinks = kinks_of(problem.punch)
    if not kinks:
        return ()
    reach = radius_at_height(problem.punch, KINK_HEIGHT * problem.law.z0)
    within = tuple(r for r in kinks if r < reach)
    if len(within) > MOST_KINKS:
        raise NotConverged(
            f"the slope of the punch jumps at {len(within)} radii below {reach:.3g}, and the mesh follows at most "
            f"{MOST_KINKS}",
            Failure.KINKS,
        )
    return within


def balance_length(problem: Problem, radius: float) -> float:
    """Return the length over which traction and stiffness balance, searched for from a contact of that radius."""
    law = problem.law
    depth = np.array(radius)
    # E(l) length / l = traction, by a fixed point in log l; a root finder moves the last digit, and with it the
    # power of 2 to which `spec` rounds.
    for _ in range(BALANCE_STEPS):
        E = plane_strain_modulus(problem.solids, depth)
        before, depth = depth, np.sqrt(depth * E * law.z0**2 / (2.0 * scale_of_energy(law)))
        if depth == before:
            break
    return float(depth)


@lru_cache(maxsize=16)
def scales(problem: Problem) -> bool:
    """Whether one mesh carries the path: the solid scales, and the edge is not too narrow for the mesh of a spot.

    The radius of the contact under adhesion is that at which the elastic energy E f^2 a, of a punch of height f pressed
    in, is the energy of adhesion w a^2.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerLaw, PowerPunch
    >>> sphere, law = PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    >>> [scales(Problem(PowerLaw(E0, 1.0, 0.0, 0.3), sphere, law)) for E0 in (1.0, 1e-5)]  # mu is 1 and 2000
    [True, False]
    """
    punch, law = problem.punch, problem.law
    if kinks_within(problem) or not are_one_power_law(problem.solids):
        return False
    radius = radius_at_height(punch, law.z0)
    for _ in range(BALANCE_STEPS):
        height, E = float(punch.height(np.array(radius))), stiffness_at(problem.solids, np.array(radius))
        if height**2 * E > scale_of_energy(law) * radius:
            break
        radius *= RADIUS_STEP
    width = WIDTH_SHARE * EDGE_PER_BALANCE * balance_length(problem, radius) / radius
    return width >= NARROWEST_OF_ONE_MESH


# Each mesh of a path asks for it again.
@lru_cache(maxsize=16)
def spot_length(problem: Problem, radius: float) -> float:
    """Return the shortest length over which traction and stiffness balance, that of the spot on which contact begins.

    Under a soft layer there are two, of which the longer is that of the solid below it.
    """
    return min(balance_length(problem, radius), balance_length(problem, SMALLEST_APEX * radius))


@lru_cache(maxsize=16)
def expected_spot(problem: Problem, size: float, rise: float) -> float:
    """Return about the radius of the spot on which contact begins, of a problem whose meshes scale.

    On a soft solid it is a share of the length of balance, and on a stiff one the radius at which the punch rises.

    Parameters
    ----------
    problem : Problem
    size : float
        Radius from which the length of balance is searched for.
    rise : float
        Radius at which the punch rises as the mesh before contact has it.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerLaw, PowerPunch
    >>> sphere, law = PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    >>> [round(expected_spot(Problem(PowerLaw(E0, 1.0, 0.4, 0.3), sphere, law), 1.4, 0.3), 3) for E0 in (50.0, 0.5)]
    [0.299, 0.047]
    """
    k = problem.solids[0].surface_exponent
    share, power = (np.polynomial.Polynomial(of_k)(k) for of_k in (SPOT_SHARE, SPOT_POWER))
    ratio = share ** (1.0 / (1.0 - k)) * balance_length(problem, size) / rise
    return float(rise * ratio * (1.0 + ratio**power) ** (-1.0 / power))


def check_width(width: float) -> None:
    """Refuse an edge, of that width relative to its radius, that is narrower than the smallest of a mesh.

    Raises
    ------
    NotConverged

    Examples
    --------
    >>> check_width(1e-3)
    """
    if width < NARROWEST:
        raise NotConverged(
            f"the contact edge needs elements of {width:.1e} of its radius, and the smallest that are meshed have "
            f"{NARROWEST:g}: the adhesion is too strong for the solid at its surface",
            Failure.MESH,
        )
