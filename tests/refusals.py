"""Exceptions that say in one sentence what is wrong."""

import pytest


def refused(words, function, *arguments, error=ValueError, **options):
    """Assert that a call raises an exception whose one sentence matches the words; return the exception."""
    with pytest.raises(error, match=words) as caught:
        function(*arguments, **options)
    assert "\n" not in str(caught.value)
    return caught.value
