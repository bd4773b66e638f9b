"""The command line: thin, and quick to answer `--help`."""

from boresight.cli.main import main as main
