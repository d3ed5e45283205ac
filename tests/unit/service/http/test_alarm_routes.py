from datetime import timedelta

import httpx
import pytest

from running_service import Running, at, buoy, eventually, running

ALARMS = "/api/v1/cages/ace/alarms"
NAME = "domain.input"


@pytest.fixture
def operator(live: Running):
    """Somebody who may handle alarms, by the name of Ingrid."""
    token = live.service.tokens.mint(["ack", "read"], keep=False, name="Ingrid")
    headers = {"Authorization": f"Bearer {token}"}
    with httpx.Client(base_url=live.address, headers=headers) as one:
        yield one


def beyond_what_was_learned(live: Running):
    """Let the cage extrapolate for longer than the alarm's delay, and return the alarm."""
    live.post(buoy(speed=2.5))
    eventually(lambda: alarm(live), lambda one: one and one["value"] == 1.0)
    live.clock.at += timedelta(minutes=11)
    return eventually(lambda: alarm(live), lambda one: one and one["active"])


def alarm(live: Running):
    alarms = live.reader.get(ALARMS).json()["alarms"]
    return next((one for one in alarms if one["id"] == NAME), None)


def done(operator: httpx.Client, how: str, **body):
    return operator.post(f"{ALARMS}/{NAME}/{how}", json=body)


def test_an_alarm_is_raised_shown_and_acknowledged_by_name(live, operator):
    raised = beyond_what_was_learned(live)
    assert raised["active"]
    assert not raised["acknowledged"]
    shown = live.state()["alarms"]
    assert [one["id"] for one in shown] == [NAME]
    answer = done(operator, "acknowledge", why="seen")
    assert answer.status_code == 200
    assert answer.json()["acknowledged"]
    (line,) = [
        line
        for line in live.reader.get("/api/v1/cages/ace/journal").json()["lines"]
        if line["action"] == "acknowledged"
    ]
    assert (line["alarm"], line["who"], line["why"]) == (NAME, "Ingrid", "seen")
    assert live.state()["alarms"][0]["acknowledged"]


def test_what_makes_no_sense_is_refused_in_a_sentence(live, operator):
    beyond_what_was_learned(live)
    done(operator, "acknowledge")
    again = done(operator, "acknowledge")
    assert (again.status_code, again.json()["detail"]) == (
        422,
        f"{NAME}: there is nothing to acknowledge.",
    )
    assert "Say why" in done(operator, "shelve", seconds=60.0).json()["detail"]
    unknown = operator.post(f"{ALARMS}/load.bridle-99/acknowledge", json={})
    assert unknown.status_code == 404


def test_shelving_has_an_end_and_can_be_ended(live, operator):
    beyond_what_was_learned(live)
    shelved = done(operator, "shelve", why="works on the buoy", seconds=600.0).json()
    assert shelved["shelved"]
    assert shelved["shelved_until"].startswith("2020-02-01T12:21")
    assert not done(operator, "unshelve").json()["shelved"]
    assert not done(operator, "out-of-service", why="spare buoy").json()["in_service"]
    assert done(operator, "in-service", why="back").json()["in_service"]
    assert done(operator, "comment", why="call me").json()["comment"] == "call me"


def test_who_only_reads_may_not_acknowledge(live):
    beyond_what_was_learned(live)
    assert live.reader.post(f"{ALARMS}/{NAME}/acknowledge", json={}).status_code == 403


def test_alarms_stand_after_a_restart_as_they_stood(tmp_path):
    with running(tmp_path) as live:
        before = beyond_what_was_learned(live)
    with running(tmp_path) as live:
        after = alarm(live)
        lines = live.reader.get("/api/v1/cages/ace/journal").json()["lines"]
    kept = ("active", "acknowledged", "since", "shelved", "in_service")
    assert {key: after[key] for key in kept} == {key: before[key] for key in kept}
    assert [line["action"] for line in lines if line["alarm"] == NAME] == ["raised"]


def test_the_journal_can_be_read_by_span(live, operator):
    beyond_what_was_learned(live)
    earlier = {"to": at(5)}
    assert live.reader.get("/api/v1/cages/ace/journal", params=earlier).json()["lines"] == []


def test_how_well_the_alarms_serve_is_counted_from_the_journal(live, operator):
    beyond_what_was_learned(live)
    done(operator, "acknowledge")
    kpi = live.reader.get("/api/v1/cages/ace/kpi").json()
    assert kpi["raised"][NAME] == 1
    assert NAME in kpi["standing"]
    assert kpi["to_acknowledge_s"] is not None
    assert kpi["chattering"] == []


def test_a_span_that_ends_before_it_starts_is_refused_in_a_sentence(live):
    answer = live.reader.get("/api/v1/cages/ace/kpi", params={"from": at(5), "to": at(0)})
    assert answer.status_code == 422
    assert "end after the start" in answer.json()["detail"]


def changed(operator: httpx.Client, **body):
    return operator.post("/api/v1/cages/ace/journal", json=body)


def test_work_on_the_cage_stands_in_the_journal_when_and_by_whom_it_was_done(live, operator):
    answer = changed(operator, change="net cleaned", why="Two discs, all sides.")
    assert answer.status_code == 200
    earlier = (live.clock.at - timedelta(hours=5)).isoformat()
    moved = changed(operator, change="sensor moved", sensor="depth-2", t=earlier)
    assert moved.json()["alarm"] == "irregular.depth-2"
    lines = live.reader.get("/api/v1/cages/ace/journal").json()["lines"]
    found = [(one["action"], one["alarm"], one["who"], one["why"]) for one in lines]
    assert found[-2:] == [
        ("sensor moved", "irregular.depth-2", "Ingrid", ""),
        ("net cleaned", "net.net", "Ingrid", "Two discs, all sides."),
    ]
    assert lines[-2]["twin"] == live.state()["twin"]


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ({"change": "sensor moved"}, "sensor = None is not among the cage's: depth-1"),
        ({"change": "sensor moved", "sensor": "buoy-1"}, "where the buoy was moved, train another"),
        ({"change": "net changed", "sensor": "depth-1"}, "has no part in 'net changed'"),
        ({"change": "net changed", "t": "2017-01-01T00:00:00Z"}, "is not within the 30 days until"),
        ({"change": "net changed", "t": "2030-01-01T00:00:00Z"}, "is not within the 30 days until"),
        ({"change": "net sold"}, "Input should be 'net changed', 'net cleaned' or 'sensor moved'"),
    ],
)
def test_a_change_that_cannot_have_been_is_refused_and_not_written_down(
    live, operator, body, reason
):
    answer = changed(operator, **body)
    assert answer.status_code == 422
    assert reason in str(answer.json()["detail"])
    assert live.reader.get("/api/v1/cages/ace/journal").json()["lines"] == []


def test_who_only_reads_may_not_write_into_the_journal(live):
    assert changed(live.reader, change="net cleaned").status_code == 403
