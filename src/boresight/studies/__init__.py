"""Monte Carlo over campaigns: thousands of simulated calibrations, on any number of workers, in one file."""

from boresight.studies.grid import AXES as AXES
from boresight.studies.grid import Bench as Bench
from boresight.studies.grid import Chosen as Chosen
from boresight.studies.grid import Point as Point
from boresight.studies.grid import Settings as Settings
from boresight.studies.grid import Study as Study
from boresight.studies.grid import grid as grid
from boresight.studies.outcome import Outcome as Outcome
from boresight.studies.run import run as run
from boresight.studies.store import Store as Store
from boresight.studies.study import study as study
from boresight.studies.summary import Summary as Summary
from boresight.studies.summary import summarise as summarise
