"""Public names besides solids, punches and laws; `__init__.py` loads a module when one of its names is first used."""

from ._numbers import BoundedNumber as BoundedNumber
from .accuracy import ACCURACIES as ACCURACIES
from .errors import (
    AccuracyWarning as AccuracyWarning,
    Failure as Failure,
    NoSuchEvent as NoSuchEvent,
    NotConverged as NotConverged,
)
from .large_strain import (
    LARGE_STRAIN_QUANTITIES as LARGE_STRAIN_QUANTITIES,
    LargeStrainPath as LargeStrainPath,
    profile_large_strain as profile_large_strain,
    solve_large_strain as solve_large_strain,
    trace_large_strain as trace_large_strain,
)
from .neo_hookean import NeoHookean as NeoHookean
from .problem import Problem as Problem
from .quantities import CRITICAL_MODULUS as CRITICAL_MODULUS, LOSSES as LOSSES, QUANTITIES as QUANTITIES
from .result import Solution as Solution
from .solid import Interface as Interface
from .solution import solve as solve, solve_together as solve_together
from .states import (
    EVENTS as EVENTS,
    EquilibriumPath as EquilibriumPath,
    RadialField as RadialField,
    event_state as event_state,
    profile as profile,
    trace as trace,
)
