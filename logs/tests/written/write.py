"""Writes the Parquet files next to it: the same samples by several writers, packed by gzip and Zstandard.

pip install duckdb numpy polars pyarrow; python write.py
"""

import os

import duckdb
import numpy
import polars
import pyarrow
import pyarrow.parquet

os.chdir(os.path.dirname(os.path.abspath(__file__)))


def samples(count):
    """Numbers that are the same in every language: quotients of small whole numbers."""
    k = numpy.arange(count)
    return {"t": k / 100, "q": k * k / 7, "tau": (k % 16) / 3}


def pyarrow_file(name, count, **options):
    table = pyarrow.table(samples(count))
    pyarrow.parquet.write_table(table, name + ".parquet", **options)


# Several row groups, and in them several pages.
pages = {"row_group_size": 150, "data_page_size": 256, "write_batch_size": 32}
second = {"data_page_version": "2.0", "use_dictionary": False}
pyarrow_file("pyarrow_gzip", 200, compression="gzip", **pages)
pyarrow_file("pyarrow_gzip_2", 200, compression="gzip", **pages, **second)
pyarrow_file("pyarrow_zstd", 200, compression="zstd", **pages)
pyarrow_file("pyarrow_zstd_2", 200, compression="zstd", **pages, **second)
pyarrow_file("small_gzip", 12, compression="gzip", store_schema=False)
pyarrow_file("small_zstd", 12, compression="zstd", store_schema=False, **second)

table = polars.DataFrame(samples(200))
table.write_parquet("polars_gzip.parquet", compression="gzip")
table.write_parquet("polars_zstd.parquet", compression="zstd")

for codec in ["gzip", "zstd"]:
    duckdb.sql(
        f"copy (select k / 100 as t, k * k / 7 as q, k % 16 / 3 as tau from range(200) of (k))"
        f" to 'duckdb_{codec}.parquet' (format parquet, compression {codec})"
    )
