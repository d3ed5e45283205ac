"""A Dask cluster that is not there; one that is there: tests/journeys."""

import pytest

from seacage.campaigns._cluster import map_on_cluster
from seacage.conventions import SeacageError


@pytest.mark.parametrize(
    ("address", "says"),
    [
        ("tcp://127.0.0.1:9", "no Dask scheduler answers"),
        ("nonsense://here:1", "unknown address scheme"),
        ("localhost", "missing port number"),
    ],
)
def test_an_address_where_no_scheduler_answers_is_reported_in_one_sentence(
    address: str, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("seacage.campaigns._cluster._CONNECT_S", 0.3)
    with pytest.raises(SeacageError, match=says) as refused:
        next(map_on_cluster(abs, [-1], address=address))
    assert "Start one with `dask scheduler`" in str(refused.value)


def test_a_scheduler_without_workers_is_reported_in_one_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from distributed import LocalCluster

    monkeypatch.setattr("seacage.campaigns._cluster._WORKER_S", 0.2)
    with (
        LocalCluster(n_workers=0, dashboard_address=":0", silence_logs=50) as cluster,
        pytest.raises(SeacageError, match=r"had no worker for 0\.2 s"),
    ):
        next(map_on_cluster(abs, [-1], address=cluster.scheduler_address))
