"""Entry point of ``python -m fscm_bench``."""

from __future__ import annotations

import sys

from fscm_bench import main

if __name__ == "__main__":
    sys.exit(main())
