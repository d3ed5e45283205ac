import json
import math
import signal
import subprocess
import sys
from datetime import UTC, datetime, timedelta

import pytest

from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._wires._mqtt_messages import Settled
from seacage.service._wires._spool import Spool, SpoolError

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


def sample(minute, **rest):
    t = NOON + timedelta(minutes=minute)
    return Sample(stream="depth-2", t=t, values={"depth_m": 14.0 + minute}, **rest)


def settled(*samples):
    return [Settled(stream=one.stream, t=one.t, seq=one.seq) for one in samples]


@pytest.fixture
def spool(tmp_path):
    one = Spool(tmp_path / "spool", to="here", most=10)
    yield one
    one.close()


def put(spool, *samples, place="1"):
    return spool.put(samples, source="file", place=place)


def times(samples):
    return [(one.t - NOON) // timedelta(minutes=1) for one in samples]


def test_what_is_put_in_comes_out_as_it_was(spool):
    odd = Sample(
        stream="buoy-1", t=NOON, seq=3, values={"hs_m": math.nan, "current_speed_m_s": 1 / 3}
    )
    put(spool, odd)
    (back,) = spool.next(10, live_after=0)
    assert (back.stream, back.t, back.seq) == ("buoy-1", NOON, 3)
    assert math.isnan(back.values["hs_m"])
    assert back.values["current_speed_m_s"] == 1 / 3


def test_live_samples_go_before_those_that_had_piled_up(spool):
    put(spool, sample(0), sample(1), sample(2))
    live_after = spool.newest
    put(spool, sample(3), sample(4))
    assert times(spool.next(4, live_after=live_after)) == [3, 4, 0, 1]
    assert times(spool.next(1, live_after=spool.newest - 1)) == [4]


def test_a_sample_waits_once_until_it_is_settled(spool):
    put(spool, sample(0), sample(1))
    put(spool, sample(1), sample(2))
    assert len(spool) == 3
    assert spool.settle(settled(sample(0), sample(1), sample(1), sample(9))) == 2
    assert times(spool.next(9, live_after=0)) == [2]


def test_samples_of_one_time_are_told_apart_by_their_number(spool):
    put(spool, sample(0, seq=1), sample(0, seq=2), sample(0))
    spool.settle(settled(sample(0, seq=2)))
    assert [one.seq for one in spool.next(9, live_after=0)] == [1, None]


def test_a_full_spool_has_its_source_wait_and_loses_nothing(spool):
    assert put(spool, *map(sample, range(10)), place="10")
    assert not put(spool, sample(10), place="11")
    assert spool.place("file") == "10", "its source is read again from there"
    spool.settle(settled(sample(0)))
    assert put(spool, sample(10), place="11")


def test_a_full_spool_may_give_up_its_oldest_and_counts_them(tmp_path):
    spool = Spool(tmp_path / "spool", to="here", most=10, drop_oldest=True)
    for minute in range(13):
        assert put(spool, sample(minute))
    assert times(spool.next(99, live_after=0)) == list(range(3, 13))
    assert (len(spool), spool.dropped) == (10, 3)
    spool.close()


def test_after_a_restart_all_is_there_and_the_place_too(tmp_path):
    for start in range(3):
        spool = Spool(tmp_path / "spool", to="here")
        assert len(spool) == start
        assert spool.place("file") == (str(start) if start else None)
        put(spool, sample(start), place=str(start + 1))
        spool.close()


def test_a_spool_of_another_destination_is_refused(tmp_path):
    Spool(tmp_path / "spool", to="mqtt://north").close()
    with pytest.raises(InputError, match="holds samples for mqtt://north, not for mqtt://south"):
        Spool(tmp_path / "spool", to="mqtt://south")


def test_two_publishers_never_share_a_spool(spool, tmp_path):
    with pytest.raises(SpoolError, match="Another publisher may be using it"):
        Spool(tmp_path / "spool", to="here")


def test_a_file_that_is_no_spool_is_said(tmp_path):
    (tmp_path / "spool").write_text("time,depth_m\n" * 100)
    with pytest.raises(SpoolError, match="does not open as a spool"):
        Spool(tmp_path / "spool", to="here")


WRITER = """
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path
from seacage.records import Sample
from seacage.service._wires._spool import Spool
spool, t = Spool(Path(sys.argv[1]), to="here"), datetime(2020, 2, 1, tzinfo=UTC)
number = int(spool.place("file") or 0)
while True:
    number += 1
    one = Sample(stream="depth-2", t=t + timedelta(seconds=number), values={"depth_m": 1.0})
    spool.put([one], source="file", place=str(number))
    print(number, flush=True)
"""


def test_a_kill_loses_nothing_that_was_put_in_and_repeats_nothing(tmp_path):
    said = 0
    for _ in range(3):
        command = [sys.executable, "-c", WRITER, str(tmp_path / "spool")]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            for _ in range(20):
                said = json.loads(process.stdout.readline())
            process.send_signal(signal.SIGKILL)
    spool = Spool(tmp_path / "spool", to="here")
    number = int(spool.place("file"))
    assert number >= said >= 60
    assert len(spool) == number
    spool.close()
