"""Rigid geometry: rotations, frames, planes and beams. Knows nothing of robots.

`T_a_b` maps coordinates in b to coordinates in a: `p_a = T_a_b p_b`. Lengths in metres, angles in radians.
"""

from boresight.geometry.frames import Frame as Frame
from boresight.geometry.frames import inverse as inverse
from boresight.geometry.frames import triple_of as triple_of
from boresight.geometry.planes import Plane as Plane
from boresight.geometry.points import Point as Point
from boresight.geometry.quaternions import matrix_quaternion as matrix_quaternion
from boresight.geometry.quaternions import quaternion_matrix as quaternion_matrix
from boresight.geometry.rays import range_to_plane as range_to_plane
from boresight.geometry.rotation_vectors import rotation_vector as rotation_vector
from boresight.geometry.rotation_vectors import vector_rotation as vector_rotation
from boresight.geometry.rotation_vectors import vector_slope as vector_slope
from boresight.geometry.rotations import matrix_rpy as matrix_rpy
from boresight.geometry.rotations import rotation_angle as rotation_angle
from boresight.geometry.rotations import rpy_matrix as rpy_matrix
from boresight.geometry.rotations import rpy_near as rpy_near
