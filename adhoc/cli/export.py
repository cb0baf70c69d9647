"""`adhoc export DIR...`: the records of runs as one flat table, for other programs."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from adhoc.cli.output_files import check_output
from adhoc.core.errors import ConfigurationError
from adhoc.experiments.exporting.columns import columns_of
from adhoc.experiments.exporting.files import write_csv, write_parquet
from adhoc.reporting.folders import records_of

EPILOG = """\
One row a record, in the order of the folders and of their lines. Fields of fields have names with dots
(llm.calls), elements of lists their number (joined_at.0). docs/provenance.md says what the types are."""


def main(arguments: Sequence[str]) -> int:
    """Write the files. Raises RecordError for folders without records or with the same ones,
    MissingDependency without pyarrow."""
    parser = argparse.ArgumentParser(
        prog="adhoc export",
        description="Write the records of runs as CSV or Parquet.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folders", nargs="+", metavar="DIR", help="a run folder, the out=... of `adhoc run`")
    parser.add_argument("--csv", metavar="FILE", type=Path, help="write a CSV file")
    parser.add_argument("--parquet", metavar="FILE", type=Path, help="write a Parquet file (adhoc[parquet])")
    options = parser.parse_args(list(arguments))
    if options.csv is None and options.parquet is None:
        raise ConfigurationError("--csv FILE or --parquet FILE must be given")
    for option, path in (("--csv", options.csv), ("--parquet", options.parquet)):
        check_output(option, path)
    columns = columns_of(records_of(options.folders))
    for path, write in ((options.csv, write_csv), (options.parquet, write_parquet)):
        if path is not None:
            write(path, columns)
            sys.stdout.write(f"{path}: {len(columns[0].cells)} rows of {len(columns)} columns\n")
    return 0
