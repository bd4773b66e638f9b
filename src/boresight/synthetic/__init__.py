"""Simulated readings of a perturbed truth (paper, section 4.2)."""

from boresight.synthetic.gross_errors import spoiled as spoiled
from boresight.synthetic.named_errors import named_errors as named_errors
from boresight.synthetic.reachable import with_reachable_points as with_reachable_points
from boresight.synthetic.readings import draw_configurations as draw_configurations
from boresight.synthetic.readings import exact_readings as exact_readings
from boresight.synthetic.readings import perturbed as perturbed
from boresight.synthetic.readings import simulated_readings as simulated_readings
