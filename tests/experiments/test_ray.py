"""A cluster of two nodes on this machine, one of which is killed in the middle of a run."""

from __future__ import annotations

import pytest
from test_workers import Progress, Provider, records_of
from worker_setups import Compare

from adhoc.core.errors import ConfigurationError, EpisodesFailed
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.plan import make_plan
from adhoc.experiments.run import run_comparison
from adhoc.experiments.workers.parent import run_in_workers

ray = pytest.importorskip("ray", reason="needs the extra [ray]")

pytestmark = [pytest.mark.slow, pytest.mark.timeout(280), pytest.mark.filterwarnings("ignore")]


@pytest.fixture
def cluster():
    from ray.cluster_utils import Cluster

    made = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    # Before there is another node: this process ends with the node that it is connected to, which on one
    # machine may be any that is there.
    ray.init(address=made.address, logging_level="ERROR", log_to_driver=False)
    made.add_node(num_cpus=1)
    made.wait_for_nodes()
    yield made
    ray.shutdown()
    made.shutdown()


class Killing(Progress):
    """Kills the second node after two episodes."""

    def __init__(self, cluster):
        super().__init__()
        self.cluster, self.killed = cluster, False

    def finished(self, record):
        super().finished(record)
        if self.count("finished") == 2:
            (node,) = self.cluster.worker_nodes
            self.cluster.remove_node(node, allow_graceful=False)
            self.killed = True


def run(folder, compare, progress, workers=2):
    from adhoc.experiments.workers.ray_crew import ray_crew

    store, provider = RunFolder(folder), Provider()
    plan = make_plan([compare.comparison(provider)], store)
    with ray_crew(compare) as crew:
        return run_in_workers(plan, crew.hire, lambda: provider, workers, store, progress)


def test_nothing_is_lost_with_a_node(tmp_path, cluster):
    compare = Compare(scenarios=12)
    progress = Killing(cluster)
    summary = run(tmp_path / "killed", compare, progress)
    run_comparison(compare.comparison(Provider()), RunFolder(tmp_path / "serial"))
    assert progress.killed
    assert (summary.run, progress.count("finished")) == (24, 24)
    assert records_of(tmp_path / "killed") == records_of(tmp_path / "serial")


def test_more_workers_than_the_cluster_has_room_for_are_no_trouble(tmp_path, cluster):
    compare = Compare("fetcher", 3)
    assert run(tmp_path, compare, Progress(), workers=5).run == 6


def test_an_error_on_a_node_ends_the_run(tmp_path, cluster):
    with pytest.raises(EpisodesFailed, match="ZeroDivisionError: a fault in a policy"):
        run(tmp_path, Compare("faulty", 2), Progress())


def test_without_an_address_it_begins_a_cluster_of_its_own(tmp_path, monkeypatch):
    monkeypatch.setenv("RAY_ADDRESS", "127.0.0.1:1")
    assert run(tmp_path, Compare("fetcher", 1), Progress(), workers=1).run == 2
    assert not ray.is_initialized()


def test_there_must_be_a_cluster_at_the_address():
    from adhoc.experiments.workers.ray_crew import ray_crew

    with pytest.raises(ConfigurationError, match=r"executor\.cpus=0"), ray_crew(Compare(), cpus=0):
        pass
    with (
        pytest.raises(ConfigurationError, match=r"executor\.address=127\.0\.0\.1:1: no cluster"),
        ray_crew(Compare(), "127.0.0.1:1"),
    ):
        pass
