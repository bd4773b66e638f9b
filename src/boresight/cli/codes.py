"""What the commands agree on: exit codes, and how far a seed counts."""

REJECTED = 2
"""The calibration ran, and its result should not be used."""

NOT_REACHED = 2
"""The commands were written, and some of the poses cannot be reached."""

INTERRUPTED = 130
"""Ctrl-C, by the shell's convention: 128 and the signal's number."""

LARGEST_SEED = 2**63 - 1
"""Seeds are counted in 64 bits, and in JSON's readers with a sign."""
