import httpx

from running_service import Running, buoy, eventually
from seacage.service._live._metrics import Metrics


def test_alarms_are_counted_by_how_bad_they_are():
    metrics = Metrics()
    metrics.count_alarms("ace", [1000, 800, 799, 1])
    text = metrics.text().decode()
    for severity, count in (("critical", 2), ("warning", 1), ("note", 1)):
        assert f'seacage_alarms{{cage="ace",severity="{severity}"}} {count}.0' in text
    metrics.count_alarms("ace", [])
    assert 'seacage_alarms{cage="ace",severity="critical"} 0.0' in metrics.text().decode()


def test_a_commit_is_timed_and_alarms_are_counted_while_a_service_runs(live: Running):
    live.post(buoy())
    counted = 'seacage_alarms{cage="ace",severity="critical"}'  # from the first tick on
    text = eventually(
        lambda: httpx.get(f"{live.address}/metrics").text, lambda text: counted in text
    )
    assert counted in text
    assert 'seacage_commit_seconds_count{cage="ace"} 1.0' in text
