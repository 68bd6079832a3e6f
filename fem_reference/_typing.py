"""Types of arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["Array", "Index"]

#: Of numbers.
Array = NDArray[np.float64]

#: Of positions in another array.
Index = NDArray[np.intp]
