"""Arms: links in D-H conventions, products of exponentials, chains of joints as in URDF, and ways between them; forward
kinematics in batches, and the twist of every parameter.
"""

from boresight.arm.arm import Arm as Arm
from boresight.arm.arm import Joint as Joint
from boresight.arm.bending import HARMONICS as HARMONICS
from boresight.arm.bending import SAG as SAG
from boresight.arm.bending import is_further as is_further
from boresight.arm.common_normals import modified_dh as modified_dh
from boresight.arm.common_normals import standard_dh as standard_dh
from boresight.arm.conventions import LINK_NUMBERS as LINK_NUMBERS
from boresight.arm.levers import DOWN as DOWN
from boresight.arm.motions import Chain as Chain
from boresight.arm.motions import Linearisation as Linearisation
from boresight.arm.motions import Motion as Motion
from boresight.arm.screws import Screw as Screw
from boresight.arm.screws import Screws as Screws
from boresight.arm.screws import screws_of as screws_of
from boresight.arm.serial import SerialChain as SerialChain
from boresight.arm.serial import SerialJoint as SerialJoint
from boresight.arm.serial import chain_of as chain_of
