"""Public names, each from its module; `__init__.py` loads a module when one of its names is first used."""

from .accuracy import ACCURACIES as ACCURACIES
from .coating import CoatingModulus as CoatingModulus
from .depth_profiles import (
    ExponentialModulus as ExponentialModulus,
    TableModulus as TableModulus,
    TablePoisson as TablePoisson,
)
from .errors import (
    AccuracyWarning as AccuracyWarning,
    NoSuchEvent as NoSuchEvent,
    NotConverged as NotConverged,
)
from .laws import LennardJones as LennardJones, Mie as Mie, SurfaceLaw as SurfaceLaw
from .modulus import (
    CustomModulus as CustomModulus,
    Interface as Interface,
    Modulus as Modulus,
    OffsetPowerLawModulus as OffsetPowerLawModulus,
    PowerLawModulus as PowerLawModulus,
)
from .poisson import CoatingPoisson as CoatingPoisson, CustomPoisson as CustomPoisson, PoissonRatio as PoissonRatio
from .problem import Problem as Problem
from .profiles import MeasuredPunch as MeasuredPunch, PowerSum as PowerSum, RoundedCone as RoundedCone
from .punch import CustomPunch as CustomPunch, PowerPunch as PowerPunch, Punch as Punch
from .quantities import CRITICAL_MODULUS as CRITICAL_MODULUS, LOSSES as LOSSES, QUANTITIES as QUANTITIES
from .result import Solution as Solution
from .solid import CustomSolid as CustomSolid, Solid as Solid
from .solution import solve as solve, solve_together as solve_together
from .states import (
    EVENTS as EVENTS,
    EquilibriumPath as EquilibriumPath,
    RadialField as RadialField,
    event_state as event_state,
    profile as profile,
    trace as trace,
)
from .tabulated_law import TabulatedLaw as TabulatedLaw

LAYERS: tuple[tuple[str, ...], ...]
