"""Calibrate a robot arm with a laser distance sensor and a flat plate, and be told how far to trust the result."""
