"""Plugin of pytest: each gate of a gates file, in each of its cases, is a test.

pytest loads it in every project where fscm-bench is installed.  So it is a package of its own, whose name no project
has, and it imports nothing of fscm-bench before a gates file is collected.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

__all__ = ["GateFailure", "GateItem", "GatesFile"]

#: Names of the options and of the entries of an ini file.
_GATES, _MODEL, _TIER, _CASES, _OUT, _JOBS = (
    f"fscm_bench_{name}" for name in ("gates", "model", "tier", "cases", "out", "jobs")
)

_OPTIONS: dict[str, dict[str, Any]] = {
    _GATES: {"metavar": "FILE", "help": "collect the gates of this file as tests"},
    _MODEL: {"metavar": "SPEC", "action": "append", "help": "a model to judge; may be repeated"},
    _TIER: {"choices": ("quick", "full"), "help": "standing cases (default: quick)"},
    _CASES: {"metavar": "FILE", "help": "cases in place of the standing ones"},
    _OUT: {"metavar": "DIR", "help": "keep the run folder here; resumed if it has some"},
    _JOBS: {"metavar": "N", "type": int, "default": 1, "help": "processes (default: 1)"},
}


class GateFailure(Exception):
    """The verdict of a gate is no pass; the message is its text."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the options."""
    group = parser.getgroup("fscm-bench", "gates of fscm-bench as tests")
    for name, option in _OPTIONS.items():
        group.addoption(f"--{name.replace('_', '-')}", dest=name, **option)
    parser.addini(_GATES, "gates file, relative to the root folder, that is collected as tests", default="")
    parser.addini(_CASES, "file of cases, relative to the root folder, in place of the standing ones", default="")
    parser.addini(_MODEL, "models to judge, one a line; a file is relative to the root folder", type="linelist")


def pytest_configure(config: pytest.Config) -> None:
    """Collect the gates file, too, if one is named."""
    path = _path_of(config, _GATES)
    models = config.getoption(_MODEL) or [_from_root(spec, config.rootpath) for spec in config.getini(_MODEL)]
    if path is None:
        if models:
            raise pytest.UsageError("--fscm-bench-model needs --fscm-bench-gates FILE, the gates to judge it by")
        return
    if not models:
        raise pytest.UsageError("--fscm-bench-gates needs --fscm-bench-model SPEC, the model to judge")
    if not path.is_file():
        raise pytest.UsageError(f"the gates file {path} does not exist")
    config.pluginmanager.register(_Collection(config, path, models), "fscm-bench-gates")
    named = [(config.invocation_params.dir / argument.partition("::")[0]).resolve() for argument in config.args]
    # An entry of an ini file adds no tests to those that are named on the command line.
    is_alone = config.args_source is pytest.Config.ArgsSource.ARGS and not config.getoption(_GATES)
    if path not in named and not is_alone:
        config.args.append(str(path))


def _path_of(config: pytest.Config, name: str) -> Path | None:
    """Return the file of an option, or else of an entry of the ini file."""
    if option := config.getoption(name):
        return (config.invocation_params.dir / option).resolve()
    return (config.rootpath / config.getini(name)).resolve() if config.getini(name) else None


def _from_root(spec: str, root: Path) -> str:
    return str(root / spec) if (root / spec.partition(".py:")[0]).exists() or ".py:" in spec else spec


class _Collection:
    """The gates file of a session, its models, and the folder of their run, which all workers share."""

    def __init__(self, config: pytest.Config, path: Path, models: list[str]) -> None:
        cases = _path_of(config, _CASES) or config.getoption(_TIER) or "quick"
        self.inputs, self.jobs = (path, models, cases), config.getoption(_JOBS)
        folder = getattr(config, "workerinput", {}).get(_OUT) or config.getoption(_OUT)
        self._temporary = None if folder else tempfile.mkdtemp(prefix="fscm-bench-")
        self.folder = Path(folder or str(self._temporary)).absolute()

    def pytest_collect_file(self, file_path: Path, parent: pytest.Collector) -> GatesFile | None:
        """Collect the gates file and no other."""
        is_of_gates = file_path.resolve() == self.inputs[0]
        return GatesFile.from_parent(parent, path=file_path, gates=self) if is_of_gates else None

    def pytest_report_header(self) -> str:
        """State what is judged."""
        path, models, cases = self.inputs
        return f"fscm-bench: {', '.join(models)} by {path}, cases {cases}"

    @pytest.hookimpl(optionalhook=True)
    def pytest_configure_node(self, node: Any) -> None:
        """Tell a worker of pytest-xdist the folder."""
        node.workerinput[_OUT] = str(self.folder)

    def pytest_unconfigure(self) -> None:
        """Remove a temporary folder."""
        if self._temporary:
            shutil.rmtree(self._temporary, ignore_errors=True)


class GatesFile(pytest.File):
    """A gates file: its items are the gates in their cases, and what else the run finds."""

    def __init__(self, *, gates: _Collection, **arguments: Any) -> None:
        super().__init__(**arguments)
        self._gates = gates
        self._verdicts: dict[str, tuple[str, str]] | None = None
        self._failure = ""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield an item for each gate, model and case; nothing is computed yet."""
        from comparisons.pipeline.expected_verdicts import expected_verdicts

        try:
            requirements = expected_verdicts(*self._gates.inputs)
        except ValueError as refusal:
            raise self.CollectError(str(refusal)) from None
        for name, requirement in requirements.items():
            yield GateItem.from_parent(self, name=name, requirement=requirement)

    def verdict(self, name: str) -> tuple[str, str]:
        """Return the verdict of an item and its text; the first call computes.

        Raises
        ------
        GateFailure
            If nothing could be judged.
        """
        from comparisons.model import ComputationFailed
        from comparisons.pipeline.expected_verdicts import verdicts_of_run

        if self._verdicts is None and not self._failure:
            try:
                self._verdicts = verdicts_of_run(*self._gates.inputs, self._gates.folder, self._gates.jobs)
            except (ValueError, OSError, ComputationFailed) as failure:
                self._failure = str(failure)
        if self._failure:
            raise GateFailure(self._failure)
        return (self._verdicts or {}).get(name, ("ERROR", "the run has no verdict on this case"))


class GateItem(pytest.Item):
    """A gate for one model in one case, or what else a run finds, such as too few cases with a value.

    PASS is a pass, XFAIL an expected failure, NOT-APPLICABLE is skipped; ERROR, FAIL, XPASS and INCONCLUSIVE fail.
    """

    def __init__(self, *, requirement: str, **arguments: Any) -> None:
        super().__init__(**arguments)
        self._requirement = requirement

    def runtest(self) -> None:
        """Raise what pytest takes for the verdict."""
        assert isinstance(self.parent, GatesFile)
        verdict, text = self.parent.verdict(self.name)
        if verdict == "NOT-APPLICABLE":
            pytest.skip(text)
        if verdict == "XFAIL":
            pytest.xfail(text)
        if verdict != "PASS":
            raise GateFailure(f"{verdict}: {text}\nrequired: {self._requirement}" if self._requirement else text)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the text of the verdict alone."""
        is_verdict = isinstance(excinfo.value, GateFailure)
        return str(excinfo.value) if is_verdict else super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Return the heading of a failure."""
        return self.path, None, self.name
