"""The command line: thin, and quick to answer `--help`."""

from boresight.cli.app import main as main
