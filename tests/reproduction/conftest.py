"""Two seeds of everything, measured once."""

import pytest

from boresight.reproduction import reproduce


@pytest.fixture(scope="session")
def found():
    return reproduce(2, seed=40, workers=1)
