"""Public names, each from its module; `__init__.py` loads a module when one of its names is first used."""

from .accuracy import ACCURACIES as ACCURACIES
from .errors import (
    AccuracyWarning as AccuracyWarning,
    NoSuchEvent as NoSuchEvent,
    NotConverged as NotConverged,
)
from .laws import LennardJones as LennardJones, Mie as Mie, SurfaceLaw as SurfaceLaw
from .modulus import Interface as Interface
from .problem import Problem as Problem
from .profiles import Ball as Ball, MeasuredPunch as MeasuredPunch, PowerSum as PowerSum, RoundedCone as RoundedCone
from .punch import CustomPunch as CustomPunch, PowerPunch as PowerPunch, Punch as Punch
from .quantities import CRITICAL_MODULUS as CRITICAL_MODULUS, LOSSES as LOSSES, QUANTITIES as QUANTITIES
from .result import Solution as Solution
from .solids import (
    Coating as Coating,
    CustomSolid as CustomSolid,
    Exponential as Exponential,
    Homogeneous as Homogeneous,
    Layers as Layers,
    OffsetPowerLaw as OffsetPowerLaw,
    PowerLaw as PowerLaw,
    Solid as Solid,
    TabulatedModulus as TabulatedModulus,
)
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
