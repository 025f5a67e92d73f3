"""What costs a second to set up, once for all tests."""

from __future__ import annotations

import pytest

from tests.stepping.plate_parts import BETWEEN_WHEELS, strike


@pytest.fixture(scope="session")
def struck():
    both = BETWEEN_WHEELS + [(ahead, -receiver, -source) for ahead, receiver, source in BETWEEN_WHEELS]
    return strike(both, 10.0)
