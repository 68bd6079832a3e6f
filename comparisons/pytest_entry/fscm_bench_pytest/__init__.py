"""Plugin of pytest: each verdict of a gates file is a test.

pytest loads it in every project where fscm-bench is installed.  So it is a package of its own, whose name no project
has, and it imports nothing of fscm-bench before a gates file is collected.
"""

from __future__ import annotations

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
    if (path is None) != (not models):
        missing = "--fscm-bench-gates FILE" if path is None else "--fscm-bench-model SPEC"
        raise pytest.UsageError(f"the gates of a model need both options: {missing} is missing")
    if path is None:
        return
    if not path.is_file():
        raise pytest.UsageError(f"the gates file {path} does not exist")
    config.pluginmanager.register(_Collection(config, path, models), "fscm-bench-gates")
    # An entry of an ini file adds no tests to those that are named on the command line.
    is_alone = config.args_source is pytest.Config.ArgsSource.ARGS and not config.getoption(_GATES)
    if not is_alone and str(path) not in config.args:
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
        self.inputs, self.jobs = (cases, path, models), config.getoption(_JOBS)
        folder = getattr(config, "workerinput", {}).get(_OUT) or config.getoption(_OUT)
        if not folder:
            temporary = tempfile.TemporaryDirectory(prefix="fscm-bench-", ignore_cleanup_errors=True)
            config.add_cleanup(temporary.cleanup)
            folder = temporary.name
        self.folder = Path(folder).absolute()

    def pytest_collect_file(self, file_path: Path, parent: pytest.Collector) -> GatesFile | None:
        """Collect the gates file and no other."""
        is_of_gates = file_path.resolve() == self.inputs[1]
        return GatesFile.from_parent(parent, path=file_path, gates=self) if is_of_gates else None

    @pytest.hookimpl(optionalhook=True)
    def pytest_configure_node(self, node: Any) -> None:
        """Tell a worker of pytest-xdist the folder."""
        node.workerinput[_OUT] = str(self.folder)


class GatesFile(pytest.File):
    """A gates file: its items are the verdicts of a run, which the collection computes."""

    def __init__(self, *, gates: _Collection, **arguments: Any) -> None:
        super().__init__(**arguments)
        self._gates = gates

    def collect(self) -> Iterator[pytest.Item]:
        """Run and judge, and yield an item for each verdict."""
        from comparisons.model import ComputationFailed
        from comparisons.pipeline.run import named_verdicts

        try:
            verdicts = named_verdicts(*self._gates.inputs, self._gates.folder, self._gates.jobs)
        except (ValueError, OSError, ComputationFailed) as refusal:
            raise self.CollectError(str(refusal)) from None
        for name, verdict, text in verdicts:
            yield GateItem.from_parent(self, name=name, verdict=verdict, text=text)


class GateItem(pytest.Item):
    """A gate for one model in one case, or what else a run finds, such as too few cases with a value.

    PASS is a pass, XFAIL an expected failure, NOT-APPLICABLE is skipped; ERROR, FAIL, XPASS and INCONCLUSIVE fail.
    """

    def __init__(self, *, verdict: str, text: str, **arguments: Any) -> None:
        super().__init__(**arguments)
        self._verdict, self._text = verdict, text

    def runtest(self) -> None:
        """Raise what pytest takes for the verdict."""
        if self._verdict == "NOT-APPLICABLE":
            pytest.skip(self._text)
        if self._verdict == "XFAIL":
            pytest.xfail(self._text)
        if self._verdict != "PASS":
            raise GateFailure(f"{self._verdict}: {self._text}")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the text of the verdict alone."""
        is_verdict = isinstance(excinfo.value, GateFailure)
        return str(excinfo.value) if is_verdict else super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Return the heading of a failure."""
        return self.path, None, self.name
