"""Pull-off, fold and zero load on the curve of a contact with a cohesive zone.

The curve is smooth in w = log(a/L).  A scan brackets every change of sign of an exact slope, Brent's method
converges it to rounding, and the error bound of a value follows from the magnitude of the terms in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from comparisons.model import Array, ComputationFailed, NotApplicable
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_contact import CohesiveContact, ContactState
from comparisons.models.quadrature import COARSE

#: Rounding of displacement, load and Griffith's relation relative to the magnitude of their terms: measured
#: worst 6e-15 against 40-digit arithmetic over 0.8 <= n <= 10, 0 <= k <= 0.95, 1e-3 <= Lambda <= 20.  The
#: bounds built on it were never below 4 times the true error of 350 random events.
STATE_ROUNDING = 1e-14

#: Below a / c = exp(-30) = 1e-13 the contact is the end point a = 0 to rounding.
_SMALLEST_W = -30.0
_WIDEST_SCAN = 100.0
_SCAN_STEP = 0.25
#: The scan reaches 1.5 times the larger contact radius of JKR and DMT at a load compressive like the pull-off.
_REACH = 1.5
#: The quadrature of the scan is good to 1e-13, its slopes to less; a smaller relative slope has no sign.
_SCAN_NOISE = 1e-11
_LOAD_MARGIN = 1e-10
_DIFFERENCE = 1e-4


@dataclass(frozen=True, slots=True)
class Event:
    """One state on the curve with the uncertainty of its place.

    Attributes
    ----------
    w : float
        log(a/L); -inf is the point of first contact.
    w_error : float
        Bound on the error of `w` (0 at the end point).
    curvature_error : float
        Bound on what `w_error` does to the quantity whose slope vanishes there.
    state : ContactState
        Arrays of one element, tilde variables.
    iterations : int
        Iterations of Brent's method.
    residual : float
        Remaining slope or load over the magnitude of its terms.
    """

    w: float
    w_error: float
    curvature_error: float
    state: ContactState
    iterations: int
    residual: float

    @property
    def load(self) -> float:
        """P, tilde."""
        return float(self.state.load[0])

    @property
    def displacement(self) -> float:
        """delta, tilde."""
        return float(self.state.displacement[0])


@dataclass(frozen=True, slots=True)
class CohesiveEvents:
    """The events of one contact, from one scan of its curve.

    Examples
    --------
    >>> from comparisons.models.graded_punch import GradedPunch
    >>> events = CohesiveEvents.scan(CohesiveContact(GradedPunch(2.0, 0.0), 5.0))
    >>> round(-events.pull_off().load, 4)  # JKR: 1.5
    1.505
    """

    contact: CohesiveContact
    w: Array
    states: ContactState

    @classmethod
    def scan(cls, contact: CohesiveContact) -> CohesiveEvents:
        """Compute states from first contact to a compressive load beyond minus the pull-off."""
        end = _end_of_scan(contact)
        start = max(_SMALLEST_W, end - _WIDEST_SCAN)
        w = np.linspace(start, end, int(np.ceil((end - start) / _SCAN_STEP)) + 1)
        return cls(contact, w, contact.at(w, COARSE))

    def first_beyond(self, load: float) -> float:
        """Return w of the first state beyond pull-off with a load, in the scan or in its steps beyond it."""
        beyond = self.w[(self.states.load >= load) & (self.w > self.pull_off().w)]
        if beyond.size:
            return float(beyond[0])
        w = float(self.w[-1])
        while self.contact.at(np.array([w]), COARSE).load[0] < load:
            w += _SCAN_STEP
        return w

    def pull_off(self) -> Event:
        """Return the deepest minimum of P; it is the end point a = 0 where P only grows with contact.

        Raises
        ------
        ComputationFailed
            If the scan saw a load below the minimum that was converged.
        """
        end_point = Event(-np.inf, 0.0, 0.0, self.contact.at(np.array([-np.inf])), 0, 0.0)
        roots = [self._root(i, "load_slope") for i in self._sign_changes("load_slope")]
        lowest = min([*(root for root in roots if root), end_point], key=lambda event: event.load)
        seen = int(np.argmin(self.states.load))
        margin = _LOAD_MARGIN * float(self.states.load_scale[seen])
        if float(self.states.load[seen]) < lowest.load - margin:
            raise ComputationFailed(
                f"the scan has a load below the pull-off {lowest.load:.6g} at log(a/L) = {self.w[seen]:.6g}"
            )
        return lowest

    def jump_out(self) -> Event:
        """Return the fold of delta that retreat meets first.

        Raises
        ------
        NotApplicable
            If delta grows with the contact radius throughout.
        """
        if not self._sign_changes("displacement_slope"):
            raise NotApplicable(
                "the displacement grows with the contact radius from the first touch: "
                "there is no fold in contact, and Eqs. 66-69 hold in contact only"
            )
        return self._largest_root("displacement_slope")

    def zero_load(self) -> Event:
        """Return the state in contact with P = 0, beyond the pull-off."""
        return self._largest_root("load")

    def _largest_root(self, name: str) -> Event:
        event = self._root(self._sign_changes(name)[-1], name)
        if event is None:
            raise ComputationFailed(f"the finer quadrature does not confirm that the {name} changes its sign")
        return event

    def _sign_changes(self, name: str) -> list[int]:
        """Return the indices i where a number of the state rises through zero up to i + 1, by more than rounding."""
        values, scales = _with_scale(self.states, name)
        rises = (values[:-1] < 0.0) & (values[1:] >= 0.0)
        real = np.abs(values) > _SCAN_NOISE * scales
        return [int(i) for i in np.nonzero(rises & (real[:-1] | real[1:]))[0]]

    def _root(self, i: int, name: str) -> Event | None:
        """Converge the root of a number of the state that the scan saw between its points i and i + 1.

        The scan is coarse: the root may lie one step to either side, or, where the number is nothing but
        rounding, not exist.  Return None then.
        """

        def relative(w: float) -> float:
            value, scale = _with_scale(self.contact.at(np.array([w])), name)
            return float(value[0] / scale[0])

        low, high = float(self.w[i]), float(self.w[i + 1])
        if not relative(low) < 0.0:
            low -= _SCAN_STEP
        if not relative(high) > 0.0:
            high += _SCAN_STEP
        if not relative(low) < 0.0 < relative(high):
            return None
        w, report = scipy.optimize.brentq(relative, low, high, xtol=4.0 * EPS, rtol=4.0 * EPS, full_output=True)
        values, scales = _with_scale(self.contact.at(w + _DIFFERENCE * np.array([-1.0, 0.0, 1.0])), name)
        slope = abs(float(values[2] - values[0])) / (2.0 * _DIFFERENCE)
        if not slope > 0.0:
            raise ComputationFailed(
                f"the root at log(a/L) = {w:.6g} is not simple to rounding; no error can be stated for it"
            )
        w_error = STATE_ROUNDING * float(scales[1]) / slope + 8.0 * EPS * (1.0 + abs(w))
        residual = abs(relative(w))
        return Event(w, w_error, 0.5 * slope * w_error**2, self.contact.at(np.array([w])), report.iterations, residual)


def _with_scale(state: ContactState, name: str) -> tuple[Array, Array]:
    """Return a number of the state and the magnitude of its terms."""
    return getattr(state, name), getattr(state, f"{name}_scale")


def _end_of_scan(contact: CohesiveContact) -> float:
    """log(a/L) at a contact radius beyond every event.

    There Hertz's load exceeds twice JKR's adhesion and twice the load of the cohesive zone at first contact.
    """
    punch = contact.punch
    n, k, s = punch.n, punch.k, punch.s
    touching = contact.at(np.array([-np.inf]))
    zone = -float(touching.load[0])
    jkr = 2.0 * punch.stiffness * punch.adhesion / (1.0 + k) / punch.hertz_load
    log_a = np.log(jkr) / (n - s)
    if zone > 0.0:  # it underflows as k -> 1 with Lambda > 1
        log_a = max(log_a, np.log(2.0 * zone / punch.hertz_load) / (n + k + 1.0))
    log_a += np.log(_REACH)

    def excess(w: float) -> float:
        return contact.log_contact_radius(w) - log_a

    low, high, step = -1.0, 1.0, 2.0
    while excess(low) > 0.0:
        low, step = low - step, 2.0 * step
    while excess(high) < 0.0:
        high, step = high + step, 2.0 * step
    w = float(scipy.optimize.brentq(excess, low, high, xtol=1e-3))
    while not float(contact.at(np.array([w]), COARSE).load[0]) > zone:
        w += 1.0
    return w
