"""Searching boxes for low costs: differential evolution and least squares. Knows no robots."""

from boresight.search.box import Box as Box
from boresight.search.devices import CPU as CPU
from boresight.search.devices import Device as Device
from boresight.search.evolution import DifferentialEvolution as DifferentialEvolution
from boresight.search.evolution import Population as Population
from boresight.search.evolution import ask as ask
from boresight.search.evolution import seed_population as seed_population
from boresight.search.evolution import tell as tell
from boresight.search.evolve import Cost as Cost
from boresight.search.evolve import Evolved as Evolved
from boresight.search.evolve import Staleness as Staleness
from boresight.search.evolve import Stretch as Stretch
from boresight.search.evolve import evolve as evolve
from boresight.search.least_squares import LeastSquares as LeastSquares
from boresight.search.least_squares import least_squares as least_squares
from boresight.search.least_squares import tall_least_squares as tall_least_squares
from boresight.search.stopping import Outcome as Outcome
from boresight.search.stopping import Stops as Stops
from boresight.search.strategies import STRATEGIES as STRATEGIES
from boresight.search.strategies import Strategy as Strategy
from boresight.search.triangles import Triangle as Triangle
from boresight.search.triangles import reduced as reduced
