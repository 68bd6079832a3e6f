"""No test fails because a machine is busy."""

from hypothesis import settings


def test_examples_have_no_deadline():
    assert settings.default.deadline is None
