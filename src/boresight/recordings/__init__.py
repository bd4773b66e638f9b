"""Recordings: what a running arm and its sensor reported over time, and the rows that can be made of it."""

from boresight.recordings.rows import Rows as Rows
from boresight.recordings.rows import Skipped as Skipped
from boresight.recordings.rows import rows_of as rows_of
from boresight.recordings.rules import Rules as Rules
from boresight.recordings.signal import Signal as Signal
from boresight.recordings.stillness import still_phases as still_phases
from boresight.recordings.trajectory import Trajectory as Trajectory
