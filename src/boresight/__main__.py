"""`python -m boresight` is `boresight`."""

from boresight.cli import main

if __name__ == "__main__":
    main()
