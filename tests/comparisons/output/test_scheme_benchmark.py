"""Ratios and measurements of the speed comparison."""

import pytest

from comparisons.output.scheme_benchmark import Measurement, compare, measure
from comparisons.runs.cases import Case
from comparisons.runs.tasks import Task, evaluate_task


def test_ratios_are_of_the_baseline_to_the_accurate_model(toys):
    accurate, baseline = (
        Measurement(evaluate_task(Task(name, "pull_off_force", Case(2, 0, 1))), 100.0)
        for name in ("exact", "ten-percent")
    )
    table = compare(accurate, baseline).set_index("")
    # The baseline is at least 0.2 - u_num from the reference, the accurate model at most u_num.
    assert table.loc["error (bound for the accurate model)", "ratio"] == pytest.approx((0.2 - 1e-9) / 1e-9)
    assert table.loc["seconds", "ratio"] == baseline.row.seconds / accurate.row.seconds


def test_a_measurement_is_made_in_a_process_of_its_own():
    task = Task("jkr", "pull_off_force", Case(2, 0, 1))
    measured = measure(task)
    assert measured.row.value == evaluate_task(task).value
    # Python with numpy and pandas takes tens of MB; a bench of one number takes no GB.
    assert measured.peak_memory is None or 20 < measured.peak_memory < 1000
