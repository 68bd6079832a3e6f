"""Observation of a model's imports and files: use of the references that it is compared with.

A hook of the interpreter (`sys.addaudithook`), which no Python code can remove, sees every import and every file that
Python opens.  It does not see what another program or a library in C opens.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.external.text_rules import one_line

__all__ = ["Observation"]

_ROOT = Path(__file__).resolve().parents[2]

#: The references, whose values the model is compared with.
_REFERENCES = ("fscm", "fem_reference")

#: Modules that state a problem and compute nothing; a model may use them.
_PROBLEM = ("errors", "laws", "physical", "problem", "punch", "_typing", "_validation", "_response_factor")
_ALLOWED = {"fscm", *(f"fscm.{name}" for name in _PROBLEM)}

#: Folders of values of the references, which are part of the package or of its repository.
_VALUES = {
    str(_ROOT / "comparisons" / "data" / "shipped"): "the shipped values of the references",
    str(_ROOT / "comparisons" / "data" / "baseline"): "the committed values of the references",
    str(_ROOT / "results" / "baseline"): "the committed values of the references",
}

#: Events of the interpreter that start another program or process, in which nothing is seen.
_STARTS = ("subprocess.Popen", "os.system", "os.fork", "os.forkpty", "os.exec", "os.posix_spawn", "os.spawn")

#: A version of NumPy of which importing any module starts no program.
_STARTS_NOTHING = (2, 4)

#: Most facts that are reported.
_MOST = 5


class Observation:
    """Facts about a model, seen while its code runs."""

    def __init__(self) -> None:
        self._uses: dict[str, None] = {}
        self._starts = False
        self._is_active = False
        _load_what_starts_a_program()
        self._modules = set(sys.modules)
        sys.addaudithook(self._see)

    @property
    def uses(self) -> list[str]:
        """What the model uses of the references: at most five facts."""
        return list(self._uses)[:_MOST]

    @property
    def starts_programs(self) -> bool:
        """Whether it started another program or process."""
        return self._starts

    @contextmanager
    def active(self) -> Iterator[None]:
        """Observe while the code of the model runs."""
        self._is_active = True
        try:
            yield
        finally:
            self._is_active = False
            for name in sys.modules.keys() - self._modules:
                self._imported(name)
            self._modules |= sys.modules.keys()

    def _see(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self._is_active:
            return
        if event == "import":
            self._imported(arguments[0])
        elif event == "open":
            self._opened(arguments[0])
        elif event in _STARTS:
            self._starts = True

    def _imported(self, name: object) -> None:
        if isinstance(name, str) and name.partition(".")[0] in _REFERENCES and name not in _ALLOWED:
            self._uses[f"imports {name.partition('.')[0]}"] = None

    def _opened(self, path: object) -> None:
        if isinstance(path, bytes):
            path = os.fsdecode(path)
        if not isinstance(path, str):
            return
        real = os.path.realpath(path)
        for folder, words in _VALUES.items():
            if real.startswith(folder + os.sep):
                self._uses[f"reads {words} ({one_line(os.path.basename(real), 60)})"] = None
        if not real.startswith(str(_ROOT) + os.sep):
            return
        # The code of a reference, read to be imported or copied, or its data.
        parts = Path(real).relative_to(_ROOT).with_suffix("").parts
        if parts[0] in _REFERENCES:
            name = ".".join(part.partition(".")[0] for part in parts if part not in ("__pycache__", "__init__"))
            self._imported(name)


def _load_what_starts_a_program() -> None:
    """Import the module of NumPy that starts ``lscpu`` when SciPy imports it, which would count for the model."""
    if tuple(map(int, np.__version__.split(".")[:2])) < _STARTS_NOTHING:
        import_module("numpy.testing")
