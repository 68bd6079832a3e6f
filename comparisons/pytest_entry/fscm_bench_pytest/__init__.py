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

__all__ = ["GateFailure", "GateItem", "GatesFile", "OtherVerdicts"]

#: Names of the options and of the entries of an ini file.
_GATES, _MODEL, _TIER, _CASES, _OUT, _JOBS = (
    f"fscm_bench_{name}" for name in ("gates", "model", "tier", "cases", "out", "jobs")
)


class GateFailure(Exception):
    """The verdict of a gate is no pass; the message is its text."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the options."""
    group = parser.getgroup("fscm-bench", "gates of fscm-bench as tests")
    group.addoption("--fscm-bench-gates", dest=_GATES, metavar="FILE", help="collect the gates of this file as tests")
    group.addoption(
        "--fscm-bench-model", dest=_MODEL, metavar="SPEC", action="append", help="a model to judge; may be repeated"
    )
    group.addoption("--fscm-bench-tier", dest=_TIER, choices=("quick", "full"), help="standing cases (default: quick)")
    group.addoption("--fscm-bench-cases", dest=_CASES, metavar="FILE", help="cases in place of the standing ones")
    group.addoption(
        "--fscm-bench-out", dest=_OUT, metavar="DIR", help="keep the run folder here; resumed if it has some"
    )
    group.addoption("--fscm-bench-jobs", dest=_JOBS, metavar="N", type=int, default=1, help="processes (default: 1)")
    parser.addini(_GATES, "gates file, relative to the root folder, that is collected as tests", default="")
    parser.addini(_CASES, "file of cases, relative to the root folder, in place of the standing ones", default="")
    parser.addini(_MODEL, "models to judge, one a line; a file is relative to the root folder", type="linelist")


def pytest_configure(config: pytest.Config) -> None:
    """Collect the gates file, too, if one is named."""
    option = config.getoption(_GATES)
    stated = option or config.getini(_GATES)
    models = config.getoption(_MODEL) or [_from_root(spec, config.rootpath) for spec in config.getini(_MODEL)]
    if not stated:
        if models:
            raise pytest.UsageError("--fscm-bench-model needs --fscm-bench-gates FILE, the gates to judge it by")
        return
    if not models:
        raise pytest.UsageError("--fscm-bench-gates needs --fscm-bench-model SPEC, the model to judge")
    path = ((config.invocation_params.dir if option else config.rootpath) / stated).resolve()
    if not path.is_file():
        raise pytest.UsageError(f"the gates file {path} does not exist")
    config.pluginmanager.register(_Collection(config, path, models), "fscm-bench-gates")
    named = [(config.invocation_params.dir / argument.partition("::")[0]).resolve() for argument in config.args]
    # An entry of an ini file adds no tests to those that are named on the command line.
    if (option or config.args_source is not pytest.Config.ArgsSource.ARGS) and path not in named:
        config.args.append(str(path))


def _from_root(spec: str, root: Path) -> str:
    return str(root / spec) if (root / spec.partition(".py:")[0]).exists() or ".py:" in spec else spec


class _Collection:
    """The gates file of a session, its models, and the folder of their run, which all workers share."""

    def __init__(self, config: pytest.Config, path: Path, models: list[str]) -> None:
        self.path, self.models = path, models
        self.cases: str | Path = config.getoption(_TIER) or "quick"
        if given_cases := config.getoption(_CASES):
            self.cases = config.invocation_params.dir / given_cases
        elif stated_cases := config.getini(_CASES):
            self.cases = config.rootpath / stated_cases
        self.jobs: int = config.getoption(_JOBS)
        given = getattr(config, "workerinput", {}).get(_OUT) or config.getoption(_OUT)
        self._temporary = None if given else tempfile.mkdtemp(prefix="fscm-bench-")
        self.folder = Path(given or str(self._temporary)).absolute()

    def pytest_collect_file(self, file_path: Path, parent: pytest.Collector) -> GatesFile | None:
        """Collect the gates file and no other."""
        return GatesFile.from_parent(parent, path=file_path, gates=self) if file_path.resolve() == self.path else None

    def pytest_report_header(self) -> str:
        """State what is judged."""
        return f"fscm-bench: {', '.join(self.models)} by {self.path}, cases {self.cases}"

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

    def __init__(self, *, gates: _Collection, **other: Any) -> None:
        super().__init__(**other)
        self._gates = gates
        self._keys: set[tuple[Any, ...]] = set()
        self._verdicts: Any = None
        self._failure = ""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield an item for each gate, model and case; nothing is computed yet."""
        from comparisons.pipeline.expected_verdicts import expected_verdicts

        try:
            expected = list(expected_verdicts(self._gates.path, self._gates.models, self._gates.cases))
        except ValueError as refusal:
            raise self.CollectError(str(refusal)) from None
        for one in expected:
            self._keys.add(one.key)
            yield GateItem.from_parent(self, name=one.name, key=one.key, requirement=one.requirement)
        yield OtherVerdicts.from_parent(self, name="other verdicts")

    def verdicts(self) -> dict[tuple[Any, ...], tuple[str, str]]:
        """Return verdict and text by gate, model and case; the first call computes.

        Raises
        ------
        GateFailure
            If nothing could be judged.
        """
        if self._verdicts is None and not self._failure:
            from comparisons.model import ComputationFailed
            from comparisons.pipeline.expected_verdicts import computed_verdicts

            run = self._gates
            try:
                self._verdicts = computed_verdicts(run.path, run.models, run.cases, run.folder, run.jobs)
            except (ValueError, OSError, ComputationFailed) as failure:
                self._failure = str(failure)
        if self._failure:
            raise GateFailure(self._failure)
        return dict(self._verdicts)

    def others(self) -> list[str]:
        """Return the texts of the verdicts that belong to no item and are no pass."""
        return [
            text
            for key, (verdict, text) in self.verdicts().items()
            if key not in self._keys and verdict in ("ERROR", "FAIL", "XPASS", "INCONCLUSIVE")
        ]


class _Item(pytest.Item):
    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the text of the verdict alone."""
        if isinstance(excinfo.value, GateFailure):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Return the heading of a failure."""
        return self.path, None, self.name


class GateItem(_Item):
    """A gate for one model in one case.

    PASS is a pass, XFAIL an expected failure, NOT-APPLICABLE is skipped; ERROR, FAIL, XPASS and INCONCLUSIVE fail.
    """

    def __init__(self, *, key: tuple[Any, ...], requirement: str, **other: Any) -> None:
        super().__init__(**other)
        self._key, self._requirement = key, requirement

    def runtest(self) -> None:
        """Raise what pytest takes for the verdict."""
        assert isinstance(self.parent, GatesFile)
        verdict, text = self.parent.verdicts().get(self._key, ("ERROR", "the run has no verdict on this case"))
        if verdict == "NOT-APPLICABLE":
            pytest.skip(text)
        if verdict == "XFAIL":
            pytest.xfail(text)
        if verdict != "PASS":
            raise GateFailure(f"{verdict}: {text}\nrequired: {self._requirement}")


class OtherVerdicts(_Item):
    """Verdicts on a gate or a model as a whole, such as too few cases with a value."""

    def runtest(self) -> None:
        """Fail if there is one."""
        assert isinstance(self.parent, GatesFile)
        if others := self.parent.others():
            raise GateFailure("\n".join(others))
