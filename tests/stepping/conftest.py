"""What costs a second to set up, once for all tests."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="session")
def struck():
    # Not above: what a conftest cannot import ends the whole run instead of a file of it.
    from tests.stepping.plate_parts import BETWEEN_WHEELS, strike

    both = BETWEEN_WHEELS + [(ahead, -receiver, -source) for ahead, receiver, source in BETWEEN_WHEELS]
    return strike(both, 10.0)
