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
    chosen = Device(device, precision)
    if chosen != CPU and not evolves:
        option = f"--device {device}" if chosen.on_card else f"--precision {precision}"
        raise InputError(f"{option} is for evolution, and none was asked for: leave it out")
    if chosen.on_card:
        from boresight.kernels.cuda.devices import require_card

        require_card()
    return chosen
