"""Arms: links in D-H conventions, forward kinematics in batches, and the twist of every parameter."""

from boresight.arm.arm import Arm as Arm
from boresight.arm.arm import Joint as Joint
from boresight.arm.bending import HARMONICS as HARMONICS
from boresight.arm.bending import SAG as SAG
from boresight.arm.bending import is_further as is_further
from boresight.arm.conventions import LINK_NUMBERS as LINK_NUMBERS
from boresight.arm.levers import DOWN as DOWN
from boresight.arm.motions import Chain as Chain
from boresight.arm.motions import Linearisation as Linearisation
from boresight.arm.motions import Motion as Motion
