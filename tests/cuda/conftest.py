"""These tests need a card: a real one, or the simulator that `tests/test_simulated_card.py` starts them in."""

import os

import pytest

SIMULATED = os.environ.get("NUMBA_ENABLE_CUDASIM") == "1"


def _reason() -> str | None:
    from boresight.errors import BoresightError
    from boresight.kernels.cuda.devices import require_card

    try:
        require_card()
    except BoresightError as error:
        return str(error)
    return None


def pytest_collection_modifyitems(items):
    here = [item for item in items if "tests/cuda/" in item.path.as_posix()]
    reason = _reason() if here else None
    for item in here:
        if reason:
            item.add_marker(pytest.mark.skip(reason=reason))
