import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.twin import AlarmPolicy, Limit

ACE = Cage.named("ace")


def test_a_table_changes_what_it_names_and_nothing_else():
    policy = AlarmPolicy.from_dict({"load": {"raise_at": 0.7, "clear_at": 0.6}}, ACE)
    usual = AlarmPolicy.default(ACE)
    assert policy.limit("load.bridle-3").raise_at == 0.7
    assert policy.limit("load.bridle-3").severity == usual.limit("load.bridle-3").severity
    assert policy.limit("volume.net") == usual.limit("volume.net")


def test_one_alarms_own_limit_goes_before_its_kinds_and_starts_from_it():
    table = {
        "load.bridle-3": {"raise_at": 0.5},
        "load": {"clear_at": 0.4, "severity": 650},
    }
    policy = AlarmPolicy.from_dict(table, ACE)
    assert policy.limit("load.bridle-3").raise_at == 0.5
    assert policy.limit("load.bridle-3").clear_at == 0.4
    assert policy.limit("load.bridle-3").severity == 650
    assert policy.limit("load.bridle-4").raise_at == 0.8


def test_a_buoy_may_be_quiet_for_longer_than_a_sensor():
    policy = AlarmPolicy.default(ACE)
    assert policy.limit("silent.buoy-1").raise_at > policy.limit("silent.depth-1").raise_at


def test_a_fault_that_has_no_limit_of_its_own_has_the_limit_of_lost_history():
    policy = AlarmPolicy.default(ACE)
    assert policy.limit("broker.mqtt") == policy.limit("history.store")


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ({"lode": {}}, "no kind of alarm 'lode'"),
        ({"load.bridle-99": {"raise_at": 0.5}}, "no alarm 'load.bridle-99'"),
        ({"load": 0.5}, "no table of limits"),
        ({"load": {"raise": 0.5}}, "the key 'raise' is unknown"),
        ({"load": {"raise_at": "high"}}, "'high' is no number"),
        ({"load": {"raise_at": True}}, "True is no number"),
        ({"load": {"severity": 500.0}}, "no whole number"),
        ({"load": {"severity": 5000}}, "alarms, load: Limit: severity = 5000"),
        ({"load": {"raise_at": 0.1}}, "alarms, load: Limit: clear_at = 0.7 is above"),
        ({"load": {"raise_at": float("nan")}}, "is no number"),
        ({"load": {"raise_at": float("inf")}}, "raise_at = inf is no number or not finite"),
        ({"load": {"clear_at": float("-inf")}}, "clear_at = -inf"),
        ({"load": {"repeat_after_s": float("inf")}}, "repeat_after_s = inf"),
    ],
)
def test_a_table_that_makes_no_sense_is_refused_in_a_sentence(table, says):
    with pytest.raises(InputError, match=says):
        AlarmPolicy.from_dict(table, ACE)


def test_without_a_cage_any_source_of_a_known_kind_may_have_a_limit():
    policy = AlarmPolicy.from_dict({"load.line-1": {"raise_at": 0.9}})
    assert policy.limit("load.line-1") == Limit(
        raise_at=0.9,
        clear_at=0.7,
        on_delay_s=60.0,
        off_delay_s=300.0,
        repeat_after_s=1800.0,
        severity=700,
    )


@pytest.mark.parametrize("number", ["raise_at", "clear_at", "on_delay_s", "repeat_after_s"])
def test_a_limit_is_made_of_finite_numbers(number):
    with pytest.raises(InputError, match="not finite"):
        Limit(**{"raise_at": 1.0, "clear_at": 0.5, number: float("inf")})
