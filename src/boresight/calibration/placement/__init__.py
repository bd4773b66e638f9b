"""Where the base and the mounts stand when nobody has measured it: found from the readings, without a guess."""

from boresight.calibration.placement.find import find_frames as find_frames
