"""One clock for the topics of a bag: the headers' where there is one, the recorder's where there is not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.files.bags.messages import Decoded


@dataclass(frozen=True)
class Clock:
    """The clock of the joint states, and how other topics are brought to it.

    Attributes:
        stamped: whether it is that of the joint states' headers.
        delay: how long after their stamps [s] the joint states reached the recorder; 0 where they have none.
        remarks: what was chosen, a sentence each.
    """

    stamped: bool
    delay: float
    remarks: tuple[str, ...]

    def time(self, topic: Decoded) -> Float[np.ndarray, " messages"]:
        """Returns when the messages of a topic were made [s]."""
        if self.stamped and topic.stamp is not None:
            return topic.stamp
        return topic.received - self.delay


def clock_of(joints: Sequence[Decoded], readings: Decoded, name: str) -> Clock:
    """Returns the clock to pair the joint states of some topics and the readings of one by.

    Args:
        joints: the topics of joint states.
        readings: the topic of readings.
        name: of that topic, for the remarks.
    """
    stamps = [topic.stamp for topic in joints]
    known = [stamp for stamp in stamps if stamp is not None]
    if len(known) < len(stamps):
        return Clock(False, 0.0, ("The joint states have no time of their own: the recorder's is used for all.",))
    late = np.concatenate([topic.received - stamp for topic, stamp in zip(joints, known, strict=True)])
    delay = float(np.median(late))
    if readings.stamp is None:
        words = (
            f"Messages of {name} have no time of their own: the recorder's is used, less the {1e3 * delay:.3g} ms "
            "by which the joint states reached it late."
        )
        return Clock(True, delay, (words,))
    start, end = min(stamp.min() for stamp in known), max(stamp.max() for stamp in known)
    if readings.stamp.max() < start or readings.stamp.min() > end:
        words = (
            f"The headers of {name} and those of the joint states tell of times that do not meet "
            f"({readings.stamp.min():.3f} to {readings.stamp.max():.3f} s, and {start:.3f} to {end:.3f} s): "
            "two clocks. The recorder's is used for both; see time_offset for what may remain."
        )
        return Clock(False, 0.0, (words,))
    return Clock(True, delay, ())
