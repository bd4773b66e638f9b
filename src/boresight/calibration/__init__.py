"""From readings to an identified arm and a verdict."""

from boresight.calibration.calibrate import calibrate as calibrate
from boresight.calibration.campaign import Campaign as Campaign
from boresight.calibration.campaign import Freedom as Freedom
from boresight.calibration.campaign import SetAside as SetAside
from boresight.calibration.inspect import Inspection as Inspection
from boresight.calibration.inspect import inspect as inspect
from boresight.calibration.result import Result as Result
from boresight.calibration.simulate import simulate as simulate
from boresight.calibration.solve import SOLVERS as SOLVERS
from boresight.calibration.solve import Solver as Solver
