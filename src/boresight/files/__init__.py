"""Files: campaigns, robots and readings, read into the package's units and written back."""

from boresight.files.campaigns import load_campaign as load_campaign
from boresight.files.observations import read_observations as read_observations
from boresight.files.results import StoredResult as StoredResult
from boresight.files.results import load_result as load_result
from boresight.files.robots import dump_robot as dump_robot
from boresight.files.robots import load_robot as load_robot
from boresight.files.studies import load_study as load_study
from boresight.files.writing import write_atomically as write_atomically
