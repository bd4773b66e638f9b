"""What residuals and Jacobians say: what can be known, how certainly, and what is left unexplained."""

from boresight.inference.excess import model_std as model_std
from boresight.inference.hardly import HardlySeen as HardlySeen
from boresight.inference.hardly import hardly_seen as hardly_seen
from boresight.inference.identifiability import Identifiability as Identifiability
from boresight.inference.identifiability import identify_directions as identify_directions
from boresight.inference.identifiability import select_visible as select_visible
from boresight.inference.movements import Movements as Movements
from boresight.inference.movements import movements_of as movements_of
from boresight.inference.observability import Observability as Observability
from boresight.inference.observability import everett_count as everett_count
from boresight.inference.observability import observability as observability
from boresight.inference.pose import PoseUncertainty as PoseUncertainty
from boresight.inference.pose import pose_uncertainty as pose_uncertainty
from boresight.inference.pose import spread_configurations as spread_configurations
from boresight.inference.pose import uncalibrated_in_words as uncalibrated_in_words
from boresight.inference.posterior import posterior_covariance as posterior_covariance
from boresight.inference.posterior import posterior_root as posterior_root
from boresight.inference.posterior import sources as sources
from boresight.inference.shrinkage import Shrunk as Shrunk
from boresight.inference.shrinkage import Squares as Squares
from boresight.inference.shrinkage import shrink as shrink
from boresight.inference.words import UnseenDirection as UnseenDirection
from boresight.inference.words import listed as listed
from boresight.inference.words import unseen_in_words as unseen_in_words
