"""A small campaign on disk, to be spoiled by the tests."""

from dataclasses import dataclass
from pathlib import Path

import pytest
from campaign_texts import CAMPAIGN, OBSERVATIONS, ROBOT, swapped

from boresight.errors import InputError
from boresight.files import load_campaign


@dataclass(frozen=True)
class Folder:
    path: Path

    def write(self, robot=ROBOT, campaign=CAMPAIGN, observations=OBSERVATIONS, **others):
        texts = {"robot.yaml": robot, "campaign.yaml": campaign, "observations.csv": observations, **others}
        for name, text in texts.items():
            content = text if isinstance(text, bytes) else text.encode()
            (self.path / name).write_bytes(content)
        return self

    def load(self, **options):
        return load_campaign("campaign.yaml", **options)

    def problems(self, **options):
        with pytest.raises(InputError) as caught:
            self.load(**options)
        return caught.value.problems

    def problem(self, **options):
        (problem,) = self.problems(**options)
        return problem


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return Folder(tmp_path).write()


@pytest.fixture
def campaign_with():
    return lambda *pairs: swapped(CAMPAIGN, *pairs)


@pytest.fixture
def robot_with():
    return lambda *pairs: swapped(ROBOT, *pairs)


@pytest.fixture
def read(folder):
    """Loads the campaign with these observations."""
    return lambda text: folder.write(observations=text).load()


@pytest.fixture
def problems(folder):
    """All that is wrong with these observations."""
    return lambda text: folder.write(observations=text).problems()


@pytest.fixture
def problem(folder):
    """The one thing that is wrong with these observations."""
    return lambda text: folder.write(observations=text).problem()
