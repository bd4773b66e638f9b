"""Results for people and programs: a folder of files, a page, and a summary on the terminal."""

from boresight.report.document import result_document as result_document
from boresight.report.document import result_json as result_json
from boresight.report.folder import check_writable as check_writable
from boresight.report.folder import write_result as write_result
