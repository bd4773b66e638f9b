"""From the tool's pose to a reading, and its derivative by a twist of the tool."""

from boresight.sensing.aims import Aim as Aim
from boresight.sensing.cell import Cell as Cell
from boresight.sensing.cell import Parameter as Parameter
from boresight.sensing.distances import Distances as Distances
from boresight.sensing.draw_wire import DrawWire as DrawWire
from boresight.sensing.laser_ranger import LaserRanger as LaserRanger
from boresight.sensing.plane_contact import PlaneContact as PlaneContact
from boresight.sensing.point_contact import PointContact as PointContact
from boresight.sensing.pose import Pose as Pose
from boresight.sensing.position import Position as Position
from boresight.sensing.readings import Readings as Readings
from boresight.sensing.sensor import Readout as Readout
from boresight.sensing.sensor import Response as Response
from boresight.sensing.sensor import Sensor as Sensor
from boresight.sensing.sensor import Target as Target
