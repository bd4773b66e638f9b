"""Whether there is a card, and what it is called."""

from __future__ import annotations

import importlib.util
import os

from boresight.errors import BoresightError

_INSTALL = "pip install 'boresight[cuda]'"


def require_card() -> str:
    """Returns the name of the card that will be used.

    Raises:
        BoresightError: there is none, or what it needs is not installed.
    """
    if importlib.util.find_spec("numba_cuda") is None:
        raise BoresightError(f"--device cuda needs numba-cuda, which is not installed: {_INSTALL}")
    from numba import cuda
    from numba.cuda.cudadrv.error import CudaSupportError

    if os.environ.get("NUMBA_ENABLE_CUDASIM") == "1":
        return "simulated card"
    try:
        name = cuda.get_current_device().name
    except CudaSupportError as error:
        said = " ".join(str(error).split()).removeprefix("Error at driver init: ").split(". ")[0].strip(" .:")
        raise BoresightError(
            f"--device cuda needs an NVIDIA card and its driver, and none was found ({said}). "
            "Use --device cpu, or run `nvidia-smi` to see what the system knows of its cards"
        ) from None
    return name.decode() if isinstance(name, bytes) else str(name)
