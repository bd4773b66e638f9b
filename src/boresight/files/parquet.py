"""Parquet as the rows of text that it stands for, so that it is read, refused and told of as CSV is.

Batch by batch, and no more than a CSV file may hold. A row's line is counted as in CSV, the names on line 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from boresight.files.sheets import Row, Sheet, with_few_columns
from boresight.files.signatures import LENGTH
from boresight.files.signatures import is_parquet as begins_as_parquet
from boresight.files.sources import OpenSource

SUFFIXES = (".parquet", ".pq")

_BATCH_ROWS = 16_384
_NUMBER_BYTES = 8
MOST_TIMES, ALWAYS_MIB = 20, 64
"""A file may stand for so many times its size, as numbers, where that is more than a little: readings hardly shrink."""

_INSTALL = "pip install 'boresight[parquet]', or export it as CSV"


def is_parquet(path: Path, file: BinaryIO) -> bool:
    """Returns whether a file is Parquet, or says so by its name; it stays at its beginning."""
    beginning = file.read(LENGTH)
    file.seek(0)
    return begins_as_parquet(beginning) or path.suffix.lower() in SUFFIXES


def parquet_sheet(source: OpenSource, *, limit_mib: int) -> Sheet:
    """Returns a Parquet file's rows; going through them raises an `InputError` for what it should not be.

    Args:
        source: the file.
        limit_mib: how much it may come to, unpacked or as CSV.
    """
    return Sheet(source.name, with_few_columns(_rows(source, limit_mib), source.name))


def _rows(source: OpenSource, limit_mib: int) -> Iterator[Row]:
    refused = source.complaint.refused
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError:
        raise refused(f"reading Parquet needs pyarrow, which is not installed: {_INSTALL}") from None
    try:
        metadata = pq.read_metadata(source.file)
        schema = metadata.schema.to_arrow_schema()
        strange = [f"{column.name} ({column.type})" for column in schema if not _is_plain(column.type)]
        if strange:
            raise refused(f"expected columns of numbers or text, got {', '.join(strange)}")
        # A word stays one word however many rows have it: a small file could name a large one a million times.
        words = [column.name for column in schema if _is_text(column.type)]
        file = pq.ParquetFile(source.file, metadata=metadata, read_dictionary=words)
        rows, columns = metadata.num_rows, len(schema)
        size = max(_unpacked(metadata), rows * columns * _NUMBER_BYTES)
        if size > limit_mib * 2**20:
            raise refused(
                f"unpacked it has {size / 2**20:,.0f} MiB; expected at most {limit_mib} MiB: thin it or split it"
            )
        own = source.file.seek(0, 2)
        if size > max(ALWAYS_MIB * 2**20, MOST_TIMES * own):
            raise refused(
                f"{rows:,} rows of {columns} columns in {own / 2**10:,.0f} KiB are {size / max(own, 1):,.0f} times its "
                f"size unpacked; expected at most {MOST_TIMES} times, since readings do not repeat so"
            )
        yield 1, schema.names
        batches = file.iter_batches(batch_size=_BATCH_ROWS, use_threads=False)
        filled = (cells for batch in batches for cells in zip(*map(_cells, batch.columns), strict=True))
        yield from ((line, list(cells)) for line, cells in enumerate(filled, 2))
    except UnicodeDecodeError:
        raise refused("it holds text that is not UTF-8; write it again") from None
    except (pa.ArrowException, OSError) as error:
        said = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise refused(f"this is no Parquet file, or a damaged one ({said})") from None


def _unpacked(metadata) -> int:
    return sum(metadata.row_group(number).total_byte_size for number in range(metadata.num_row_groups))


def _is_text(kind) -> bool:
    import pyarrow.types as types

    return types.is_string(kind) or types.is_large_string(kind)


def _is_plain(kind) -> bool:
    """Returns whether CSV can hold a column of this type."""
    import pyarrow.types as types

    if types.is_dictionary(kind):
        return _is_plain(kind.value_type)
    plain = (types.is_integer, types.is_floating, types.is_boolean, types.is_null, types.is_decimal)
    dates = types.is_temporal(kind) and not types.is_duration(kind)
    return dates or _is_text(kind) or any(each(kind) for each in plain)


def _cells(column) -> list[str]:
    """Returns the cells of a batch's column as CSV has them; the same words are the same objects."""
    import pyarrow as pa

    if pa.types.is_dictionary(column.type):
        words = _cells(column.dictionary)
        return [words[place] if place is not None else "" for place in column.indices.to_pylist()]
    if pa.types.is_float16(column.type):
        column = column.cast(pa.float64())
    return column.cast(pa.string()).fill_null("").to_pylist()
