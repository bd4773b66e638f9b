"""What all tests share: shape annotations are executed, and hypothesis keeps to a budget.

The import hook must be installed before the package is imported. The compiled loops are left out: numba
reads their source as it stands.
"""

import jaxtyping
from hypothesis import settings

jaxtyping.install_import_hook(["boresight.geometry", "boresight.arm", "boresight.sensing"], "beartype.beartype")

settings.register_profile("boresight", deadline=None, max_examples=60, derandomize=True)
settings.load_profile("boresight")
