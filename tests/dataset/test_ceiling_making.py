from __future__ import annotations

import pytest

from adhoc.core.errors import ConfigurationError
from adhoc.dataset.files.ceiling_file import read_ceilings
from adhoc.dataset.files.dataset_folder import DatasetSplit
from adhoc.dataset.making.ceiling_making import make_ceilings


def test_every_task_gets_the_verdict_that_is_read_back(copied):
    told = []
    made = make_ceilings(copied, "test", workers=1, progress=lambda *progress: told.append(progress))
    data = DatasetSplit(copied, "test")
    assert [verdict.task_id for verdict in made] == list(data.ids)
    assert list(read_ceilings(data.files).values()) == made
    assert told[-1][:2] == (2, 2)
    assert all(verdict.joint_steps for verdict in made if verdict.kind != "none")


def test_processes_change_nothing(copied):
    files = DatasetSplit(copied, "test").files
    make_ceilings(copied, "test", workers=1)
    alone = files.ceilings.read_bytes()
    make_ceilings(copied, "test", workers=2)
    assert files.ceilings.read_bytes() == alone


def test_fewer_steps_allow_less(copied):
    made = make_ceilings(copied, "test", workers=1, max_steps=1)
    assert {verdict.kind for verdict in made} == {"none"}


def test_no_workers_are_refused(copied):
    with pytest.raises(ConfigurationError, match="workers=0"):
        make_ceilings(copied, "test", workers=0)
