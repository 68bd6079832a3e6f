"""Entry point of ``python -m fscm_bench``."""

from __future__ import annotations

import sys

if __name__ == "__main__" and not sys.flags.safe_path:
    # `python -m` puts the working folder first, which may hold a model and modules of any name.
    del sys.path[0]

from fscm_bench import main

if __name__ == "__main__":
    sys.exit(main())
