"""Independence of the tests from the speed of the machine."""

from hypothesis import settings


def test_examples_have_no_deadline():
    assert settings.default.deadline is None
