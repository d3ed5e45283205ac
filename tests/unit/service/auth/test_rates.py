import pytest

from seacage.service._auth._limits import Rates


def test_a_bucket_lets_a_burst_pass_and_then_as_many_as_time_fills_in():
    rates = Rates(per_s=2.0, burst=3.0)
    assert [rates.wait_s("ada", 0.0) for _ in range(3)] == [0.0, 0.0, 0.0]
    assert rates.wait_s("ada", 0.0) == pytest.approx(0.5)
    assert rates.wait_s("ada", 0.5) == 0.0
    assert rates.wait_s("ada", 0.5) == pytest.approx(0.5)


def test_a_bucket_never_holds_more_than_its_burst():
    rates = Rates(per_s=1.0, burst=2.0)
    rates.wait_s("ada", 0.0)
    assert [rates.wait_s("ada", 1e6) > 0.0 for _ in range(3)] == [False, False, True]


def test_one_asker_does_not_use_up_the_bucket_of_another():
    rates = Rates(per_s=1.0, burst=1.0)
    assert rates.wait_s("ada", 0.0) == rates.wait_s("bob", 0.0) == 0.0
    assert rates.wait_s("ada", 0.0) > 0.0


def test_those_who_called_longest_ago_are_forgotten(monkeypatch):
    monkeypatch.setattr("seacage.service._auth._limits._MOST_ASKERS", 2)
    rates = Rates(per_s=1e-6, burst=1.0)
    for asker in ("ada", "bob", "cy"):
        rates.wait_s(asker, 0.0)
    assert rates.wait_s("cy", 0.0) > 0.0
    assert rates.wait_s("ada", 0.0) == 0.0
