"""The paper's section 4, done again: its tables, figures and statements beside what is measured."""

from boresight.reproduction.document import Document as Document
from boresight.reproduction.document import compose as compose
from boresight.reproduction.folder import write_reproduction as write_reproduction
from boresight.reproduction.measurements import Measurements as Measurements
from boresight.reproduction.reproduce import reproduce as reproduce
