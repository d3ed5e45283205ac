import httpx
import pytest

from running_service import Running, at, buoy, depth, running

ROOT = "/sta/v1.1"
SPEED = f"{ROOT}/Datastreams('ace:buoy-1:current_speed_m_s')"


def get_path(live, path, **options):
    """The answer to a path; options go without their dollar."""
    params = {f"${name}": value for name, value in options.items()}
    answer = live.reader.get(path, params=params or None)
    assert answer.status_code == 200, answer.text
    return answer.json()


def value(live, path, **options):
    return get_path(live, path, **options)["value"]


def walked(live, path, **options):
    """All that a list holds, page by page along its links."""
    page = get_path(live, path, **options)
    found, pages = [*page["value"]], 1
    while link := page.get("@iot.nextLink"):
        assert pages < 100
        page, pages = get_path(live, link), pages + 1
        found += page["value"]
    return found, pages


def minutes(observed):
    return [int(one["phenomenonTime"][14:16]) for one in observed]


@pytest.fixture
def farm(tmp_path):
    """Three cages, two of which have said something."""
    with running(tmp_path, names=("ace", "bay", "cove")) as one:
        one.post(buoy(-30), buoy(-20), buoy(-10), depth(-5))
        one.post(buoy(-15), cage="bay")
        yield one


def test_the_root_names_sets_that_are_there(idle: Running):
    sets = value(idle, ROOT)
    for one in sets:
        assert isinstance(value(idle, one["url"]), list)
    assert {"Things", "Datastreams", "ObservedProperties"} <= {one["name"] for one in sets}


@pytest.mark.parametrize("name", ["Things", "Sensors", "ObservedProperties", "Datastreams"])
def test_every_link_of_an_entity_leads_to_what_belongs_to_it(idle: Running, name):
    entity = value(idle, f"{ROOT}/{name}")[0]
    assert get_path(idle, entity["@iot.selfLink"]) == entity
    links = {key: link for key, link in entity.items() if key.endswith("navigationLink")}
    assert links
    for key, link in links.items():
        assert link.startswith(idle.address), "a client asks for it as it is"
        found = get_path(idle, link)
        for one in found.get("value", [found]):
            ids = {one["@iot.id"], entity["@iot.id"]}
            assert any(a in b for a in ids for b in ids), (key, ids)


def test_each_quantity_of_each_stream_is_a_datastream(idle: Running):
    streams = value(idle, f"{ROOT}/Datastreams")
    assert len(streams) == sum(len(keys) for keys in idle.cage.streams.values())
    assert len(value(idle, f"{ROOT}/Things('ace')/Datastreams")) == len(streams)
    speeds = value(idle, f"{ROOT}/ObservedProperties('current_speed_m_s')/Datastreams")
    assert [one["@iot.id"] for one in speeds] == ["ace:buoy-1:current_speed_m_s"]


def test_observations_are_raw_readings_with_their_flags(live: Running):
    live.post(buoy(-30), buoy(-20, speed=-1.0), buoy(-10, speed=None), depth(-5))
    observed = value(live, f"{SPEED}/Observations")
    assert [(one["result"], one["resultQuality"]) for one in observed] == [
        (0.5, 1),
        (-1.0, 4),
        (None, 9),
    ]
    assert observed[0]["resultTime"] == "2020-02-01T11:30:00Z"
    newest = value(live, f"{SPEED}/Observations", orderby="resultTime desc", top=2)
    assert [one["result"] for one in newest] == [None, -1.0]
    rest = value(live, f"{SPEED}/Observations", skip=2)
    assert [one["result"] for one in rest] == [None]


@pytest.mark.parametrize(
    ("term", "found"),
    [
        ("resultTime ge {t}", [40, 50]),
        ("resultTime gt {t}", [50]),
        ("resultTime le {t}", [30, 40]),
        ("resultTime lt {t}", [30]),
        ("phenomenonTime eq {t}", [40]),
        ("resultTime gt {t} and resultTime lt {t}", []),
    ],
)
def test_observations_are_filtered_by_time(live: Running, term, found):
    live.post(buoy(-30), buoy(-20), buoy(-10))
    kept = value(live, f"{SPEED}/Observations", filter=term.format(t=at(-20)))
    assert minutes(kept) == found


@pytest.mark.parametrize("order", ["phenomenonTime asc", "phenomenonTime desc"])
@pytest.mark.parametrize("top", [1, 2, 3, 7, 100])
def test_the_pages_of_observations_hold_each_once_and_in_order(live: Running, order, top):
    # Some come at one time, told apart by their number alone.
    live.post(*(buoy(-50 + 10 * (k // 3), seq=k) for k in range(13)))
    found, pages = walked(live, f"{SPEED}/Observations", top=top, orderby=order)
    ids = [one["@iot.id"] for one in found]
    assert len(ids) == len(set(ids)) == 13
    assert pages == -(-13 // top)
    assert minutes(found) == sorted(minutes(found), reverse=order.endswith("desc"))


def test_pages_keep_to_the_span_that_was_requested(live: Running):
    live.post(*(buoy(-50 + 5 * k) for k in range(10)))
    span = f"phenomenonTime ge {at(-40)} and phenomenonTime lt {at(-10)}"
    for order in ("phenomenonTime", "phenomenonTime desc"):
        found, pages = walked(live, f"{SPEED}/Observations", top=2, filter=span, orderby=order)
        assert sorted(minutes(found)) == [20, 25, 30, 35, 40, 45]
        assert pages == 3


def test_a_list_has_pages_and_a_count(farm: Running):
    page = get_path(farm, f"{ROOT}/Things", top=2, count="true")
    assert page["@iot.count"] == 3
    found, pages = walked(farm, f"{ROOT}/Things", top=2, orderby="name desc", select="name")
    assert (found, pages) == ([{"name": "cove"}, {"name": "bay"}, {"name": "ace"}], 2)
    whole = get_path(farm, f"{ROOT}/Things")
    assert whole.keys() == {"value"}


def test_observations_are_counted_over_their_span_and_not_over_their_page(live: Running):
    live.post(buoy(-30), buoy(-20), buoy(-10))
    page = get_path(live, f"{SPEED}/Observations", top=1, count="true")
    assert (len(page["value"]), page["@iot.count"]) == (1, 3)
    later = get_path(live, f"{SPEED}/Observations", count="true", filter=f"resultTime gt {at(-25)}")
    assert later["@iot.count"] == 2


def test_more_than_can_be_counted_is_refused_and_not_guessed(live: Running, monkeypatch):
    live.post(buoy(-30), buoy(-20), buoy(-10))
    monkeypatch.setattr("seacage.service._http._sensorthings._routes.FARTHEST", 2)
    assert "shorter time" in refused(live, f"{SPEED}/Observations", count="true", top=1)
    assert len(value(live, f"{SPEED}/Observations", top=1)) == 1


@pytest.mark.parametrize(
    ("inner", "fits"),
    [("$top=1", True), ("$top=3", False), ("$top=1;$skip=2", False), ("$top=1;$count=true", False)],
)
def test_an_expansion_may_look_at_so_many_samples(farm: Running, monkeypatch, inner, fits):
    monkeypatch.setattr("seacage.service._http._sensorthings._routes._AT_ONCE", 4)
    expand = f"Datastreams($top=1;$expand=Observations({inner}))"  # three samples of one stream
    if fits:
        assert get_path(farm, f"{ROOT}/Things('ace')", expand=expand)["Datastreams"]
    else:
        assert "expand less" in refused(farm, f"{ROOT}/Things('ace')", expand=expand)


def test_an_expansion_that_multiplies_too_far_is_refused(farm: Running, monkeypatch):
    monkeypatch.setattr("seacage.service._http._sensorthings._routes._AT_ONCE", 100)
    assert value(farm, f"{ROOT}/Things", expand="Datastreams")
    assert "expand less" in refused(farm, f"{ROOT}/Things", expand="Datastreams/Thing/Datastreams")


def test_the_newest_of_every_stream_of_every_cage_comes_in_one_answer(farm: Running):
    inner = "Observations($top=1;$orderby=phenomenonTime desc;$select=result,phenomenonTime)"
    things = value(
        farm, f"{ROOT}/Things", select="name", expand=f"Datastreams($select=name;$expand={inner})"
    )
    assert [one.keys() for one in things] == [{"name", "Datastreams"}] * 3
    newest = {
        (thing["name"], stream["name"]): stream["Observations"]
        for thing in things
        for stream in thing["Datastreams"]
    }
    speed = "current_speed_m_s of buoy-1"
    assert newest["ace", speed] == [{"phenomenonTime": "2020-02-01T11:50:00Z", "result": 0.5}]
    assert newest["bay", speed][0]["phenomenonTime"] == "2020-02-01T11:45:00Z"
    assert newest["cove", speed] == []


def test_what_is_expanded_in_part_says_where_its_rest_is(farm: Running):
    (thing,) = value(
        farm, f"{ROOT}/Things", top=1, expand="Datastreams($top=2;$count=true;$select=name)"
    )
    assert thing["Datastreams@iot.count"] == len(value(farm, f"{ROOT}/Things('ace')/Datastreams"))
    rest, _ = walked(farm, thing["Datastreams@iot.nextLink"])
    assert len(thing["Datastreams"]) + len(rest) == thing["Datastreams@iot.count"]


def test_a_datastream_is_given_with_what_it_leads_to(idle: Running):
    stream = get_path(idle, SPEED, expand="Sensor,ObservedProperty,Thing/Datastreams($top=1)")
    assert stream["Sensor"]["name"] == "buoy-1"
    assert stream["ObservedProperty"]["name"] == "current_speed_m_s"
    assert len(stream["Thing"]["Datastreams"]) == 1
    assert "Sensor@iot.navigationLink" not in stream
    assert "Observations@iot.navigationLink" in stream


def test_only_what_is_selected_is_given(idle: Running):
    assert get_path(idle, f"{ROOT}/Things('ace')", select="id,name,Datastreams") == {
        "@iot.id": "ace",
        "name": "ace",
        "Datastreams@iot.navigationLink": f"{idle.address}{ROOT}/Things('ace')/Datastreams",
    }


def refused(live, path, **options):
    answer = live.reader.get(path, params={f"${name}": one for name, one in options.items()})
    assert answer.status_code == 422, answer.text
    return answer.json()["detail"]


@pytest.mark.parametrize(
    ("path", "options", "why"),
    [
        (f"{SPEED}/Observations", {"filter": "result gt 3"}, "filtered by time"),
        (f"{SPEED}/Observations", {"filter": "resultTime ge yesterday"}, "no time with its zone"),
        (f"{SPEED}/Observations", {"filter": "resultTime ge 2020-01-01T00:00:00"}, "zone"),
        (f"{SPEED}/Observations", {"orderby": "result"}, "phenomenonTime or resultTime"),
        (f"{SPEED}/Observations", {"select": "unit"}, "have no 'unit'"),
        (f"{SPEED}/Observations", {"expand": "Datastream"}, "nothing more"),
        (f"{SPEED}/Observations", {"resultFormat": "dataArray"}, "$resultFormat is not offered"),
        (f"{ROOT}/Things", {"filter": "name eq 'ace'"}, "filtered by time"),
        (f"{ROOT}/Things", {"filter": f"resultTime ge {at(0)}"}, "only Observations"),
        (f"{ROOT}/Things", {"orderby": "properties"}, "text"),
        (f"{ROOT}/Things", {"orderby": "name up"}, "not understood"),
        (f"{ROOT}/Things", {"expand": "Sensors"}, "There are Locations, Datastreams"),
        (f"{ROOT}/Things", {"expand": "Datastreams($top=0)"}, "1 to 1000"),
        (f"{ROOT}/Things", {"expand": "Datastreams($count=yes)"}, "neither true nor false"),
        (f"{ROOT}/Things", {"expand": "Datastreams($ask=1)"}, "$ask is not offered"),
        (f"{ROOT}/Things", {"expand": "Datastreams("}, "not understood"),
        (f"{ROOT}/Things", {"expand": "Datastreams/Thing/Datastreams/Thing"}, "at most 3"),
        (f"{ROOT}/Things('ace')", {"top": "1"}, "$top is not offered here"),
    ],
)
def test_what_is_not_offered_or_not_understood_is_refused_in_words(
    idle: Running, path, options, why
):
    assert why in refused(idle, path, **options)


@pytest.mark.parametrize("path", ["Things('ice')", "Things('ice')/Datastreams", "Sensors('ace')"])
def test_what_is_not_there_is_not_found(idle: Running, path):
    assert idle.reader.get(f"{ROOT}/{path}").status_code == 404


def test_a_token_sees_the_things_of_its_cages_alone(idle: Running):
    for scope, seen in (("read:ice", 0), ("read:ace", 1)):
        token = idle.service.tokens.mint([scope], keep=False)
        headers = {"Authorization": f"Bearer {token}"}
        answer = httpx.get(f"{idle.address}{ROOT}/Things", headers=headers)
        assert len(answer.json()["value"]) == seen
