"""Numbers on the command line are those that are written plainly."""

import pytest

CAMPAIGN = ("calibrate", "campaign.yaml")


@pytest.mark.parametrize("written", ["1.5", "1_0", "0x10", "١", " 7", "7.0", "1e3"])
def test_a_seed_is_a_whole_number_in_plain_digits(boresight, written):
    said = boresight(*CAMPAIGN, "--seed", written)
    assert said.code == 1
    assert "Invalid value for --seed: expected a whole number" in said.out + said.err


@pytest.mark.parametrize("written", ["1_0", "٣", "one"])
def test_a_measure_is_a_number_in_plain_digits(boresight, written):
    said = boresight("import", "run", "--time-offset", written)
    assert said.code == 1
    assert "Invalid value for --time-offset: expected a number" in said.out + said.err
