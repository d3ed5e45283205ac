import httpx
import pytest

from serviced import Running, at, buoy, depth

SPEED = "/sta/v1.1/Datastreams('ace:buoy-1:current_speed_m_s')"


def value(live, path, **params):
    answer = live.reader.get(path, params=params)
    assert answer.status_code == 200, answer.text
    return answer.json()["value"]


def test_the_root_names_sets_that_are_there(idle: Running):
    sets = value(idle, "/sta/v1.1")
    for one in sets:
        assert isinstance(value(idle, one["url"]), list)
    assert {"Things", "Datastreams", "ObservedProperties"} <= {one["name"] for one in sets}


def test_each_quantity_of_each_stream_is_a_datastream_whose_links_lead_somewhere(idle: Running):
    streams = value(idle, "/sta/v1.1/Datastreams")
    assert len(streams) == sum(len(keys) for keys in idle.cage.streams.values())
    links = [link for key, link in streams[0].items() if key.endswith("navigationLink")]
    assert len(links) == 4
    for link in (*links, streams[0]["@iot.selfLink"]):
        assert idle.reader.get(link).status_code == 200, link


def test_observations_are_raw_readings_with_their_flags(live: Running):
    live.post(buoy(-30), buoy(-20, speed=-1.0), buoy(-10, speed=None), depth(-5))
    observed = value(live, f"{SPEED}/Observations")
    assert [(one["result"], one["resultQuality"]) for one in observed] == [
        (0.5, 1),
        (-1.0, 4),
        (None, 9),
    ]
    assert observed[0]["resultTime"] == "2020-02-01T11:30:00Z"
    newest = value(live, f"{SPEED}/Observations", **{"$orderby": "resultTime desc", "$top": 2})
    assert [one["result"] for one in newest] == [None, -1.0]
    rest = value(live, f"{SPEED}/Observations", **{"$skip": 2})
    assert [one["result"] for one in rest] == [None]


@pytest.mark.parametrize(
    ("term", "minutes"),
    [
        ("resultTime ge {t}", [40, 50]),
        ("resultTime gt {t}", [50]),
        ("resultTime le {t}", [30, 40]),
        ("resultTime lt {t}", [30]),
        ("phenomenonTime eq {t}", [40]),
        ("resultTime gt {t} and resultTime lt {t}", []),
    ],
)
def test_observations_are_filtered_by_time(live: Running, term, minutes):
    live.post(buoy(-30), buoy(-20), buoy(-10))
    within = {"$filter": term.format(t=at(-20))}
    found = value(live, f"{SPEED}/Observations", **within)
    assert [int(one["resultTime"][14:16]) for one in found] == minutes


def test_what_is_not_understood_is_refused(idle: Running):
    for within in ("result gt 3", "resultTime ge yesterday", "resultTime ge 2020-01-01T00:00:00"):
        answer = idle.reader.get(f"{SPEED}/Observations", params={"$filter": within})
        assert answer.status_code == 422
    assert idle.reader.get("/sta/v1.1/Things('ice')").status_code == 404


def test_a_token_sees_the_things_of_its_cages_alone(idle: Running):
    for scope, seen in (("read:ice", 0), ("read:ace", 1)):
        token = idle.service.tokens.mint([scope], keep=False)
        headers = {"Authorization": f"Bearer {token}"}
        answer = httpx.get(f"{idle.address}/sta/v1.1/Things", headers=headers)
        assert len(answer.json()["value"]) == seen
