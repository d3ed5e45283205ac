"""Gauges of cages, and the dashboard that asks for them."""

import json
import re
from datetime import timedelta
from pathlib import Path

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families

from running_service import NOON, Running, at, buoy, depth, eventually, running
from seacage.service._ingest._mqtt_feed import MqttFeed
from seacage.service._live import _cage
from seacage.service._quarantine import Quarantine
from seacage.service._schemas._quantities import QUANTITIES
from wavy import wavy_twin

BOARD = json.loads(Path(__file__).parents[4].joinpath("packaging/grafana/seacage.json").read_text())
WAVES = {"hs_m": 1.2, "tp_s": 6.0, "wave_from_deg": 270.0}
# Intervals of lines take a level 2 of lines, which is long to train; the table names them
RARE = {f"seacage_line_maximum_3h_{end}_newtons" for end in ("lower", "upper")}
WORDS = {"by", "or", "max", "sum", "count", "rate", "sort_desc", "histogram_quantile"}


def scrape(live: Running) -> dict[str, list]:
    """Samples by name, as Prometheus reads them."""
    found = dict[str, list]()
    for family in text_string_to_metric_families(httpx.get(f"{live.address}/metrics").text):
        for sample in family.samples:
            found.setdefault(sample.name, []).append(sample)
    return found


def value(live: Running, name: str, **labels: str) -> float | None:
    """One number of a scrape; None where there is no series."""
    wanted = {"cage": "ace", **labels}
    return next((s.value for s in scrape(live).get(name, ()) if s.labels == wanted), None)


def test_every_number_is_that_of_the_state_in_si(live: Running):
    live.post(buoy(), depth())
    state = eventually(live.state, lambda state: state["valid"])
    (first, *_), (second,) = state["bridles"], [s for s in state["sensors"] if s["measured"]]
    tension = first["tension_kn"]
    for end, kn in (("", "mean"), ("_lower", "lower"), ("_upper", "upper")):
        found = value(live, f"seacage_bridle_tension{end}_newtons", bridle=first["name"])
        assert found == pytest.approx(1000.0 * tension[kn])
    assert value(live, "seacage_depth_measured_meters", depth=second["name"]) == second["measured"]
    assert value(live, "seacage_net_volume_ratio") == state["volume_fraction"]
    assert value(live, "seacage_water_current_speed_meters_per_second") == 0.5
    assert value(live, "seacage_twin_info", origin="virtual field", twin="") == 1.0
    assert value(live, "seacage_bridle_measured_newtons", bridle=first["name"]) is None


def test_without_valid_input_there_is_no_number_and_no_age(live: Running):
    found = scrape(live)
    assert [s.value for s in found["seacage_valid"]] == [0.0]
    numbers = {one.metric for one in QUANTITIES if not one.flag}
    assert not numbers & found.keys(), "an age of 0 s would say that a reading has just come"


def fall_silent(live: Running) -> dict[str, float]:
    """Have a sensor send nothing for an hour; severities of the active alarms."""
    live.post(buoy(), depth())
    eventually(live.state, lambda state: state["valid"])
    name = "seacage_active_alarm_severity"
    for minute in (60, 62):  # the alarm waits for its on-delay
        live.clock.at = NOON + timedelta(minutes=minute)
        live.post(buoy(minute))
        eventually(live.state, lambda state, t=live.clock.at: state["t"] >= t.isoformat()[:19])
    return eventually(
        lambda: {s.labels["alarm"]: s.value for s in scrape(live).get(name, ())},
        lambda found: "silent.depth-2" in found,
    )


def test_an_active_alarm_has_a_series_until_it_clears(live: Running):
    severity = fall_silent(live)["silent.depth-2"]
    alarms = live.reader.get("/api/v1/cages/ace/alarms").json()["alarms"]
    active = {one["id"]: one["severity"] for one in alarms if one["active"]}
    assert active["silent.depth-2"] == severity
    live.post(depth(62))
    name, labels = "seacage_active_alarm_severity", {"alarm": "silent.depth-2"}
    assert eventually(lambda: value(live, name, **labels), lambda v: v is None) is None


def test_a_cage_that_is_no_longer_stepped_has_no_series(live: Running, monkeypatch):
    live.post(buoy())
    assert eventually(lambda: value(live, "seacage_valid"), bool) == 1.0
    monkeypatch.setattr(_cage, "STALLED_S", -60.0)
    assert value(live, "seacage_valid") is None


def test_a_token_for_one_cage_reads_its_gauges_alone(tmp_path):
    with running(tmp_path, names=("ace", "two")) as live:
        token = live.service.tokens.mint(["read:two"], keep=False)
        text = httpx.get(
            f"{live.address}/metrics",
            headers={"Authorization": f"Bearer {token}", "X-Forwarded-For": "10.0.0.9"},
        ).text
    assert 'seacage_valid{cage="two"}' in text
    assert "ace" not in text


@pytest.fixture(scope="module")
def full(tmp_path_factory):
    """Label names and values of all that there is in scrapes of two services, by metric.

    One has sensors, intervals, a broker and an alarm, the other lines in waves.
    """
    found = dict[str, dict[str, set[str]]]()
    first, second = (tmp_path_factory.mktemp(name) for name in ("sensors", "lines"))
    with running(first) as live, live.cage.subscribe():
        MqttFeed(
            "mqtt://127.0.0.1",
            site="bay",
            cages=live.service.cages,
            client_id="me",
            metrics=live.service.metrics,
            quarantine=Quarantine(first / "quarantine.jsonl"),
        )
        live.service.metrics.dropped.labels("half a request").inc()
        fall_silent(live)
        live.post(depth(62), {"stream": "shackle-1", "t": at(62), "values": {"tension_kn": 12.0}})
        eventually(lambda: scrape(live), lambda now: "seacage_bridle_measured_newtons" in now)
        note(found, scrape(live))
    with running(second, twin=wavy_twin()) as live:
        sample = buoy()
        live.post({**sample, "values": sample["values"] | WAVES})
        eventually(live.state, lambda state: state["valid"])
        note(found, scrape(live))
    return found


def note(found, scraped):
    for name, samples in scraped.items():
        for sample in samples:
            for label, text in sample.labels.items():
                found.setdefault(name, {}).setdefault(label, set()).add(text)
        found.setdefault(name, {})


def targets():
    """Queries of the dashboard with the labels that their legends show, by panel."""
    for one in BOARD["templating"]["list"]:
        if one["type"] == "query":
            query, label = re.fullmatch(r"label_values\((.+), (\w+)\)", one["definition"]).groups()
            yield one["name"], query, {label}
    for panel in BOARD["panels"]:
        for target in panel.get("targets", ()):
            shown = set(re.findall(r"\{\{(\w+)\}\}", target["legendFormat"]))
            yield panel["title"], target["expr"], shown - {"instance"}  # Prometheus' own


@pytest.mark.parametrize(("panel", "query", "shown"), list(targets()))
def test_each_query_of_the_dashboard_names_metrics_and_labels_that_there_are(
    full, panel, query, shown
):
    by = {label for found in re.findall(r"by \((.+?)\)", query) for label in found.split(", ")}
    bare = re.sub(r"by \(.+?\)|\{.*?\}|\[\w+\]", " ", query)
    metrics = set(re.findall(r"[a-z_]\w*", bare)) - WORDS
    assert metrics
    missing = metrics - full.keys()
    assert missing <= RARE, f"{panel}: there is no {missing}"
    labels = {label for metric in metrics for label in full.get(metric, {"cage": (), "line": ()})}
    for metric, matchers in re.findall(r"(\w+)\{(.*?)\}", query):
        for label, _, text in re.findall(r'(\w+)(=~?)"(.*?)"', matchers):
            assert label in labels, f"{panel}: {metric} has no label {label}"
            assert "$" in text or text in full[metric][label], f"{panel}: no {label} is {text}"
    assert by <= labels
    assert shown <= (by or labels)


def test_the_dashboard_asks_for_every_load_and_its_datasource_is_chosen():
    asked = " ".join(query for _, query, _ in targets())
    for one in QUANTITIES:
        if one.part in {"bridle", "line", "water", "net"} and one.name != "std_kn":
            assert one.metric in asked, one.metric
    sources = {
        json.dumps(target["datasource"]) for p in BOARD["panels"] for target in p.get("targets", ())
    }
    assert sources == {'{"type": "prometheus", "uid": "${datasource}"}'}
