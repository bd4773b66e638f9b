"""What is claimed of Boresight, measured: `python -m benchmarks NAME [--quick] [--json]`.

Each benchmark is a module with a function `run(quick)` that returns a `Report`.
"""
