"""Devices as Home Assistant would read them: its published names, and its templates rendered."""

import json
import re

import pytest
from jinja2.sandbox import ImmutableSandboxedEnvironment

from running_service import buoy, depth, eventually, running
from seacage.service._mqtt._home_assistant import device_message
from seacage.service._mqtt._topics import Topics
from wavy import wavy_twin

# https://www.home-assistant.io/integrations/mqtt/#device-discovery-payload
DEVICE = {"device", "origin", "components", "state_topic", "availability", "qos", "encoding"}
# https://www.home-assistant.io/integrations/sensor.mqtt/#device
ABOUT = {"identifiers", "name", "manufacturer", "model", "sw_version", "hw_version"}
ORIGIN = {"name", "sw_version", "support_url"}
# https://www.home-assistant.io/integrations/sensor.mqtt/ and binary_sensor.mqtt/
BOTH = {"platform", "name", "unique_id", "value_template", "expire_after", "device_class"}
ENTITY = {
    "sensor": BOTH | {"unit_of_measurement", "state_class", "suggested_display_precision"},
    "binary_sensor": BOTH,
}
# https://www.home-assistant.io/integrations/sensor/#device-class, and each one's units of ours
CLASSES = {"speed": {"m/s"}, "distance": {"m"}, "duration": {"s"}}
# https://www.home-assistant.io/integrations/binary_sensor/#device-class
BINARY = {"problem", "safety", "connectivity"}
TOPICS = Topics("bay")


def rendered(template: str, message: dict) -> str:
    """A template's text, as Home Assistant has it of a message of JSON."""
    return ImmutableSandboxedEnvironment().from_string(template).render(value_json=message)


def described(live):
    """The description of a cage, and the state that is published beside it."""
    state = live.cage.snapshot.state
    _, about = device_message("homeassistant", state, TOPICS, client="seacage-bay-0", every_s=10.0)
    return json.loads(about), json.loads(state.model_dump_json())


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """What a cage with lines and a cage with sensors say, and what each is described as."""
    found = []
    for twin in (None, wavy_twin()):
        with running(tmp_path_factory.mktemp("cage"), twin=twin) as live:
            before = described(live)
            sample = buoy(hs_m=1.0)
            values = sample.pop("values") | {"hs_m": 1.2, "tp_s": 6.0, "wave_from_deg": 270.0}
            sample.pop("hs_m")
            live.post({**sample, "values": values}, *([] if twin else [depth()]))
            eventually(live.state, lambda state: state["valid"])
            found.append((before, described(live)))
    return found


def entities(seen):
    for before, after in seen:
        for about, message in (before, after):
            for key, one in about["components"].items():
                yield key, one, message


def test_every_field_is_one_that_home_assistant_publishes(seen):
    for about, state in (pair for both in seen for pair in both):
        assert about.keys() <= DEVICE
        assert about["device"].keys() <= ABOUT
        assert about["origin"].keys() <= ORIGIN
        assert about["device"]["model"].endswith(f"({state['origin']})")
    for _, one, _ in entities(seen):
        assert one.keys() <= ENTITY[one["platform"]], one
        if one["platform"] == "binary_sensor":
            assert one["device_class"] in BINARY
        elif "device_class" in one:
            assert one["unit_of_measurement"] in CLASSES[one["device_class"]]
        assert one.get("state_class", "measurement") == "measurement"


def test_entities_are_told_apart_for_ever(seen):
    for _, (about, _) in seen:
        ids = [one["unique_id"] for one in about["components"].values()]
        names = [one["name"] for one in about["components"].values()]
        assert len(set(ids)) == len(ids)
        assert len(set(names)) == len(names)
        assert all(one.startswith("bay/ace/") for one in ids)


def test_each_template_gives_the_number_of_the_state(seen):
    (_, (sensors, state)), (_, (lines, wavy)) = seen
    components = sensors["components"]

    def shown(key, of=components, message=state):
        return rendered(of[key]["value_template"], message)

    for bridle in state["bridles"]:
        key = f"bridle-{bridle['name']}"
        assert float(shown(f"{key}-tension_kn")) == bridle["tension_kn"]["mean"]
        share = 100.0 * bridle["utilisation"]
        assert float(shown(f"{key}-utilisation")) == pytest.approx(share, abs=0.005)
    assert components["bridle-bridle-1-utilisation"]["unit_of_measurement"] == "%"
    assert float(shown("depth-depth-2-measured_m")) == 14.0
    assert shown("depth-depth-1-measured_m") == "None", "which Home Assistant shows as unknown"
    assert float(shown("water-current_to_deg")) == 90.0
    assert float(shown("net-volume")) == pytest.approx(100.0 * state["volume_fraction"])
    assert shown("cage-valid") == "ON"
    for line in wavy["lines"]:
        found = shown(f"line-{line['name']}-maximum_3h_kn", lines["components"], wavy)
        assert float(found) == line["maximum_3h_kn"]["mean"]


def test_without_valid_input_every_number_is_unknown(seen):
    for (about, state), _ in seen:
        assert not state["valid"]
        for one in about["components"].values():
            text = rendered(one["value_template"], state)
            assert text in ({"None"} if one["platform"] == "sensor" else {"OFF"})


def test_alarms_are_on_while_one_is_active(seen):
    _, (about, state) = seen[0]
    for severity, active, shown in (
        (500, True, "ON OFF"),
        (900, True, "ON ON"),
        (900, False, "OFF OFF"),
    ):
        alarm = {"id": "load.bridle-1", "severity": severity, "active": active}
        message = state | {"alarms": [alarm]}
        keys = ("alarm", "critical-alarm")
        texts = [rendered(about["components"][key]["value_template"], message) for key in keys]
        assert " ".join(texts) == shown


def test_presence_is_that_of_the_service(seen):
    _, (about, _) = seen[0]
    (presence,) = about["availability"]
    assert presence["topic"] == TOPICS.status("seacage-bay-0")
    assert rendered(presence["value_template"], {"status": "online", "cages": ["ace"]}) == "online"
    assert about["state_topic"] == TOPICS.outgoing("ace", "state")


def test_topics_have_the_form_that_home_assistant_takes_and_no_two_cages_share_one(idle):
    names = ["a.b", "a_b", "a__b", "a-b", "a_-b", "a._b"]
    state, how = idle.cage.snapshot.state, {"client": "me", "every_s": 10.0}
    states = [state.model_copy(update={"cage": name}) for name in names]
    topics = [device_message("homeassistant", one, TOPICS, **how)[0] for one in states]
    assert len(set(topics)) == len(names)
    form = r"homeassistant/device/[a-zA-Z0-9_-]+/[a-zA-Z0-9_-]+/config"
    assert all(re.fullmatch(form, topic) for topic in topics)
