"""residuals.csv: a row a reading, each channel of each sensor in its own column and unit."""

import csv
import io
from types import SimpleNamespace

import numpy as np

from boresight.report.tables import residuals_csv
from random_cells import mixed_cell, near_readings


def test_every_error_stands_in_its_channels_column_and_nowhere_else():
    rng = np.random.default_rng(3)
    cell = mixed_cell(rng)
    readings = near_readings(rng, cell, 60, 1e-3)
    errors = {when: rng.normal(size=readings.values.shape) for when in ("before", "after")}
    errors["after"][5] = np.nan  # a beam that misses
    flagged = [SimpleNamespace(line=int(readings.line[7]))]
    result = SimpleNamespace(cell=cell, readings=readings, errors=errors, outliers=flagged)
    rows = list(csv.DictReader(io.StringIO(residuals_csv(result))))
    assert len(rows) == len(readings)
    for place, row in enumerate(rows):
        aim = cell.aims[readings.target[place]]
        sensor = cell.sensors[aim.sensor]
        assert row["line"] == str(readings.line[place])
        assert (row["sensor"], row["marker"], row["target"]) == (aim.sensor, aim.mount, aim.target or "")
        assert row["outlier"] == ("1" if place == 7 else "0")
        expected = {}
        for channel, (name, lever) in enumerate(zip(sensor.channels, sensor.levers, strict=True)):
            for when, each in errors.items():
                if np.isfinite(each[place, channel]):
                    error = -each[place, channel] / (lever or 1.0)
                    expected[f"{when}_{name}_{'m' if lever is None else 'rad'}"] = error
        told = {name: float(cell) for name, cell in row.items() if name[:6] in ("before", "after_") and cell}
        assert told.keys() == expected.keys()
        np.testing.assert_allclose([told[name] for name in expected], list(expected.values()), rtol=1e-8)
