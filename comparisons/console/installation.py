"""Installation: clashes with distributions that have packages of the same names, and extras that are not installed.

Only the standard library is imported here, and no package is imported for the check: it takes less than a millisecond.
"""

from __future__ import annotations

import os
import re
from importlib.util import find_spec
from pathlib import Path

__all__ = ["EXTRAS", "check_packages", "sentence_on_missing_module"]

_PACKAGES = ("fscm", "fem_reference", "comparisons")

#: Module -> the extra of fscm-bench that installs it.
EXTRAS = {"bokeh": "report"}

#: Metadata of a distribution that is called as one of the packages, as the `fscm` and the `comparisons` of PyPI.
_OTHERS = re.compile(rf"({'|'.join(_PACKAGES)})-([^-]+)(-py[^-]*)?\.(dist|egg)-info", re.IGNORECASE)


def check_packages(root: Path | None = None) -> None:
    """Refuse packages of which another distribution may have replaced files.

    Parameters
    ----------
    root : Path, optional
        The folder that contains the packages; by default that of the package that runs.

    Raises
    ------
    ValueError
        One sentence on the first clash, with the remedy.

    Examples
    --------
    >>> check_packages()
    """
    root = root or Path(__file__).resolve().parents[2]
    for name in sorted(os.listdir(root)):
        if clash := _OTHERS.fullmatch(name):
            package, version = clash[1], clash[2]
            raise ValueError(
                f"the distribution {package} {version} of another project is installed in {root} too, and writes to "
                f"the same folder {package} as fscm-bench: pip uninstall {package}, then pip install "
                "--force-reinstall --no-deps with the clone or the wheel of fscm-bench; or use a virtual environment "
                "for each"
            )
    for package in _PACKAGES:
        spec = find_spec(package)
        folders = [str(Path(folder).resolve()) for folder in (spec and spec.submodule_search_locations) or []]
        if str(root / package) not in folders:
            raise ValueError(
                f"Python finds {(spec and spec.origin) or folders or 'nothing'} as the package {package}, and not "
                f"{root / package} of fscm-bench: pip uninstall the distribution it belongs to, take its folder out of "
                "PYTHONPATH, or use a virtual environment"
            )


def sentence_on_missing_module(error: ModuleNotFoundError) -> str | None:
    """Return how to install the extra that has a missing module; None if no extra has it.

    Examples
    --------
    >>> sentence_on_missing_module(ModuleNotFoundError("No module named 'bokeh'", name="bokeh"))
    "the package bokeh is not installed, which this command needs: pip install 'fscm-bench[report]'"
    """
    module = (error.name or "").partition(".")[0]
    if module not in EXTRAS:
        return None
    return (
        f"the package {module} is not installed, which this command needs: pip install 'fscm-bench[{EXTRAS[module]}]'"
    )
