"""From the tool's pose to a reading, and its derivative by a twist of the tool."""

from boresight.sensing.cell import Cell as Cell
from boresight.sensing.cell import Parameter as Parameter
from boresight.sensing.laser_ranger import LaserRanger as LaserRanger
from boresight.sensing.position import Position as Position
from boresight.sensing.readings import Readings as Readings
from boresight.sensing.sensor import Readout as Readout
from boresight.sensing.sensor import Response as Response
from boresight.sensing.sensor import Sensor as Sensor
