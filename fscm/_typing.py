"""Types that the modules share."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["Array", "ComplexArray"]

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
