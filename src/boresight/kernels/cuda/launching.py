"""A batch on the card: its arrays, and the launches that advance them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import cuda

from boresight.kernels.cuda.batches import Batch
from boresight.kernels.cuda.evolving import evolving_kernel


def on_card(arrays: Any) -> Any:
    """Returns a named tuple of arrays with its arrays on the card."""
    return type(arrays)(*(cuda.to_device(array) for array in arrays))


class Launch:
    """The populations of a batch on the card, kept there from one launch to the next.

    Attributes:
        members: (runs, parameters * members).
        costs: (runs, members).
        stale: (runs,) generations since the best last improved.
        done: (runs,) generations of the last launch.
    """

    def __init__(self, batch: Batch, real: type[np.floating], limits: tuple[float, int, float]) -> None:
        """Puts a batch on the card.

        Args:
            batch: what to evolve.
            real: precision.
            limits: cost at which to stop, stale generations at which to stop, relative improvement that counts.
        """
        shape, breeding, runs = batch.shape, batch.breeding, len(batch.keys)
        self.members = cuda.device_array((runs, shape.parameters * shape.members), real)
        self.costs = cuda.device_array((runs, shape.members), real)
        self.stale, self.done = cuda.to_device(np.zeros(runs, np.int64)), cuda.device_array(runs, np.int64)
        shared = shape.shared_bytes(real) if shape.in_shared(real) else 0
        self._kernel = evolving_kernel(shape, np.dtype(real).name)[runs, shape.threads, 0, shared]
        self._batch = (
            on_card(batch.program),
            on_card(batch.rows),
            cuda.to_device(breeding.lower),
            cuda.to_device(breeding.upper),
            (float(breeding.pull), float(breeding.scale), float(breeding.spread), float(breeding.crossover)),
            bool(breeding.from_current),
            bool(breeding.downhill),
            cuda.to_device(batch.keys),
        )
        self._limits = (float(limits[0]), int(limits[1]), float(limits[2]))
        self._reference = cuda.to_device(np.zeros(runs))
        self._trials, self._trial_costs = cuda.device_array_like(self.members), cuda.device_array_like(self.costs)
        self._leaders = cuda.device_array((runs, shape.elite), np.int32)

    def history(self, generations: int) -> Any:
        """Returns memory on the card for the best and mean costs of some generations, (runs, generations, 2)."""
        return cuda.device_array((self.done.shape[0], generations, 2), np.float64)

    def advance(self, first: int, history: Any) -> None:
        """Runs as many generations as a history holds, from a number on; 0 is the first population itself."""
        self._kernel(
            *self._batch, first, self._limits, self.members, self.costs, self.stale, self._reference, self.done,
            history, self._trials, self._trial_costs, self._leaders,
        )  # fmt: skip
