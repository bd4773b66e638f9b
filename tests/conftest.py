"""What all tests share: shape annotations are executed, compiled code is never stale, hypothesis is replayable.

The import hook must be installed before the package is imported. The compiled loops are left out of it: numba
reads their source as it stands. Numba's cache knows when a function's own file changed, but not when a file
it calls into did, so the tests keep one cache for each state of the sources.
"""

import hashlib
import os
from pathlib import Path

import jaxtyping
from hypothesis import settings

ROOT = Path(__file__).parents[1]
COMPILED = sorted((ROOT / "src" / "boresight" / "kernels").glob("*.py"))

state = hashlib.sha256(b"".join(source.read_bytes() for source in COMPILED)).hexdigest()[:16]
os.environ["NUMBA_CACHE_DIR"] = str(ROOT / ".pytest_cache" / "numba" / state)

jaxtyping.install_import_hook(["boresight.geometry", "boresight.arm", "boresight.sensing"], "beartype.beartype")

settings.register_profile("boresight", deadline=None, max_examples=60, derandomize=True, database=None)
settings.load_profile("boresight")
