"""Commands that put the calibrated arm where the nominal arm was asked to go."""

from boresight.compensation.compensate import compensate as compensate
from boresight.compensation.compensation import Compensation as Compensation
from boresight.compensation.compensation import Reached as Reached
