"""Parquet as the CSV that it stands for, so that both are read, refused and told of alike.

Batch by batch, and no more than a CSV file may hold. A row's line is counted as in CSV, the names on line 1.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from boresight.errors import InputError
from boresight.files.problems import printable
from boresight.files.sources import Source

SUFFIXES = (".parquet", ".pq")

_BATCH_ROWS = 65_536
_INSTALL = "pip install 'boresight[parquet]', or export it as CSV"


def is_parquet(path: Path) -> bool:
    """Returns whether a file's name says that it is Parquet."""
    return path.suffix.lower() in SUFFIXES


def as_csv(source: Source, *, limit_mib: int, named_by: str = "") -> Source:
    """Returns a Parquet file's content as CSV.

    Args:
        source: the file.
        limit_mib: how much CSV it may come to.
        named_by: the place that names the file, as the beginning of a sentence.

    Raises:
        InputError: it is none, is damaged, holds too much or what no CSV can, or pyarrow is missing.
    """

    def refused(why: str) -> InputError:
        return InputError(printable(f"{named_by}{source.name}: {why}"))

    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError:
        raise refused(f"reading Parquet needs pyarrow, which is not installed: {_INSTALL}") from None
    try:
        file = pq.ParquetFile(pa.BufferReader(source.content), memory_map=False)
        groups = (file.metadata.row_group(number) for number in range(file.metadata.num_row_groups))
        size = sum(group.total_byte_size for group in groups)
        if size > limit_mib * 2**20:
            raise refused(
                f"unpacked it has {size / 2**20:,.0f} MiB; expected at most {limit_mib} MiB: thin it or split it"
            )
        schema = file.schema_arrow
        strange = [f"{column.name} ({column.type})" for column in schema if not _is_plain(column.type)]
        if strange:
            raise refused(f"expected columns of numbers or text, got {', '.join(strange)}")
        return replace(source, content=_written(file, limit_mib, refused))
    except (pa.ArrowException, OSError) as error:
        said = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise refused(f"this is no Parquet file, or a damaged one ({said})") from None


def _is_plain(kind) -> bool:
    """Returns whether CSV can hold a column of this type."""
    import pyarrow.types as types

    if types.is_dictionary(kind):
        return _is_plain(kind.value_type)
    plain = (types.is_integer, types.is_floating, types.is_boolean, types.is_string, types.is_large_string)
    return any(each(kind) for each in (*plain, types.is_null, types.is_temporal, types.is_decimal))


def _written(file, limit_mib: int, refused: Callable[[str], InputError]) -> bytes:
    import pyarrow as pa
    import pyarrow.csv as csv

    out = io.BytesIO()
    header = pa.table({column.name: pa.array([], pa.string()) for column in file.schema_arrow})
    csv.write_csv(header, out, csv.WriteOptions(quoting_style="needed"))
    for batch in file.iter_batches(batch_size=_BATCH_ROWS, use_threads=False):
        plain = pa.table([_decoded(column) for column in batch.columns], names=batch.schema.names)
        csv.write_csv(plain, out, csv.WriteOptions(include_header=False, quoting_style="needed"))
        if out.tell() > limit_mib * 2**20:
            raise refused(f"as CSV it has more than {limit_mib} MiB: thin it or split it")
    return out.getvalue()


def _decoded(column):
    import pyarrow as pa

    if pa.types.is_dictionary(column.type):
        column = column.dictionary_decode()
    return column.cast(pa.float64()) if pa.types.is_float16(column.type) else column
