"""`--device` and `--precision`."""

from __future__ import annotations

from boresight.errors import InputError
from boresight.search import CPU, Device
from boresight.search.devices import DeviceName, Precision


def chosen_device(device: DeviceName, precision: Precision, *, evolves: bool) -> Device:
    """Returns where evolution is to run.

    Args:
        device: as asked for.
        precision: as asked for.
        evolves: whether an evolution runs at all.

    Raises:
        InputError: there is nothing for it to do, or it cannot do it.
        BoresightError: there is no card.
    """
    if device == "cpu":
        if precision == "single":
            raise InputError("--precision single is for a card: give --device cuda too, or leave it out")
        return CPU
    if not evolves:
        raise InputError("--device cuda runs evolution, and none was asked for: leave it out")
    from boresight.kernels.cuda.devices import require_card

    require_card()
    return Device(device, precision)
