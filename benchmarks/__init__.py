"""What is claimed of Boresight, measured: `python -m benchmarks [NAME] [--quick] [--json] [--gpu]`.

Without a name, speed. Each benchmark is a module or package with a function `run(quick)` that returns a `Report`.
"""
