"""Rigid geometry: rotations, frames, planes and beams. Knows nothing of robots.

`T_a_b` maps coordinates in b to coordinates in a: `p_a = T_a_b p_b`. Lengths in metres, angles in radians.
"""

from boresight.geometry.frames import Frame as Frame
from boresight.geometry.frames import inverse as inverse
from boresight.geometry.planes import Plane as Plane
from boresight.geometry.rays import range_to_plane as range_to_plane
from boresight.geometry.rotations import matrix_rpy as matrix_rpy
from boresight.geometry.rotations import rotation_angle as rotation_angle
from boresight.geometry.rotations import rpy_matrix as rpy_matrix
from boresight.geometry.rotations import rpy_near as rpy_near
