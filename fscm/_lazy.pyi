"""Public names; `__init__.py` loads a module when one of its names is first used."""

from ._surface.kernel import Phi as Phi, Psi as Psi, ring_response as ring_response
from ._numbers import BoundedNumber as BoundedNumber
from .accuracy import ACCURACIES as ACCURACIES
from ._sensitivity import SENSITIVE as SENSITIVE, ValueSensitivity as ValueSensitivity, sensitivity as sensitivity
from .analysis import Analysis as Analysis
from .errors import (
    Failure as Failure,
    AccuracyWarning as AccuracyWarning,
    NoSuchEvent as NoSuchEvent,
    NotConverged as NotConverged,
    OutsideAtlas as OutsideAtlas,
)
from .experiment import (
    Cycle as Cycle,
    displacement_cycle as displacement_cycle,
    load_controlled_retreat as load_controlled_retreat,
)
from .interpolation.atlas import ATLAS_QUANTITIES as ATLAS_QUANTITIES, AtlasValue as AtlasValue, atlas as atlas
from .interpolation.curve.force_curve import ForceCurve as ForceCurve, force_curve as force_curve
from .many import ManySolutions as ManySolutions, solve_many as solve_many
from .path import EquilibriumPath as EquilibriumPath, trace as trace
from .problem import Problem as Problem
from .quantities import EVENTS as EVENTS
from .solution import Solution as Solution
from .solver import QUANTITIES as QUANTITIES, solve as solve, solve_together as solve_together
from .stability import Stability as Stability
from .states import (
    EquilibriumState as EquilibriumState,
    RadialField as RadialField,
    equilibria as equilibria,
    profile as profile,
)
from .cohesive_laws import CohesiveExponential as CohesiveExponential, CohesiveTrapezoid as CohesiveTrapezoid
from .custom_punch import CustomPunch as CustomPunch
from .custom_solid import CustomSolid as CustomSolid
from .dlvo import Dlvo as Dlvo
from .laws import LennardJones as LennardJones, Mie as Mie, SurfaceLaw as SurfaceLaw
from .layers import Layers as Layers
from .measured_punch import MeasuredPunch as MeasuredPunch
from .punch import (
    Ball as Ball,
    Cone as Cone,
    PowerPunch as PowerPunch,
    PowerSum as PowerSum,
    PunchShape as PunchShape,
    RoundedCone as RoundedCone,
    Sphere as Sphere,
)
from .solids import (
    Coating as Coating,
    Exponential as Exponential,
    GradedHalfSpace as GradedHalfSpace,
    Homogeneous as Homogeneous,
    OffsetPowerLaw as OffsetPowerLaw,
    PowerLaw as PowerLaw,
)
from .tabulated_law import TabulatedLaw as TabulatedLaw
from .tabulated_modulus import TabulatedModulus as TabulatedModulus
