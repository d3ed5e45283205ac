import json
import math
import shutil
import signal
import sqlite3
import stat
import subprocess
import sys
from datetime import UTC, datetime, timedelta

import pytest

from running_service import HandClock
from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._mqtt._messages import Settled
from seacage.service._publish._sources import line_batches
from seacage.service._publish._spool import Spool, SpoolError

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


def test_samples_of_one_time_are_distinguished_by_their_number(spool):
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


def ahead(*samples):
    return [
        Settled(stream=one.stream, t=one.t, seq=one.seq, rejected="It is ahead.", retry=True)
        for one in samples
    ]


def quarantined(tmp_path):
    path = tmp_path / "spool.quarantine.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def test_what_is_ahead_of_the_services_clock_waits_apart_also_after_a_restart(tmp_path):
    spool = Spool(tmp_path / "spool", to="here", most=10)
    put(spool, sample(2), sample(1), sample(0))
    spool.hold(ahead(sample(2), sample(1)))
    spool.close()
    spool = Spool(tmp_path / "spool", to="here", most=10)
    assert (len(spool), spool.ahead) == (3, 2)
    assert times(spool.next(9, live_after=0)) == [0]
    assert times(spool.next_ahead(9)) == [1, 2], "those first whose time comes first"
    put(spool, sample(1))
    assert times(spool.next(9, live_after=0)) == [0], "read again it goes on waiting"
    assert spool.settle(settled(sample(1), sample(0))) == 2
    assert (len(spool), spool.ahead) == (1, 1)
    spool.close()


def test_what_is_ahead_takes_no_room_from_the_others_and_beyond_its_own_is_set_aside(
    spool, tmp_path
):
    for minute in range(0, 30, 10):
        assert put(spool, *map(sample, range(minute, minute + 10)))
        spool.hold(ahead(*map(sample, range(minute, minute + 10))))
        spool.expire(timedelta(days=7))
    assert (len(spool), spool.ahead, spool.quarantined) == (10, 10, 20)
    assert len(quarantined(tmp_path)) == 20


def test_after_a_week_what_is_ahead_is_set_aside_with_the_reason_and_can_be_sent_again(tmp_path):
    clock = HandClock()
    spool = Spool(tmp_path / "spool", to="here", now=clock.now)
    put(spool, sample(0), sample(1))
    spool.hold(ahead(sample(0)))
    clock.at += timedelta(days=6)
    spool.hold(ahead(sample(0), sample(1)))
    clock.at += timedelta(days=1)
    spool.expire(timedelta(days=7))
    assert times(spool.next_ahead(9)) == [1], "a later refusal does not begin the week anew"
    (line,) = quarantined(tmp_path)
    assert line["reason"] == "It is ahead."
    (again,) = line_batches([[line["payload"].encode() + b"\n"]], refuse=pytest.fail)
    assert again.samples == (sample(0),)
    spool.close()


def test_what_cannot_be_set_aside_stays(spool, tmp_path):
    put(spool, sample(0))
    spool.hold(ahead(sample(0)))
    (tmp_path / "spool.quarantine.jsonl").mkdir()
    spool.expire(timedelta(0))
    assert times(spool.next_ahead(9)) == [0]


def test_a_spool_can_be_read_by_its_owner_alone(tmp_path):
    for name in ("spool", "spool-wal"):
        (tmp_path / name).touch(0o644)
    spool = Spool(tmp_path / "spool", to="here")
    put(spool, sample(0))
    files = [one for one in tmp_path.iterdir() if one.is_file()]
    assert len(files) >= 2
    assert {stat.S_IMODE(one.stat().st_mode) for one in files} == {0o600}
    spool.close()


def test_a_sample_that_the_disk_spoiled_is_set_aside_and_takes_no_other_with_it(tmp_path):
    spool = Spool(tmp_path / "spool", to="here")
    put(spool, *map(sample, range(5)))
    spool.close()
    with sqlite3.connect(tmp_path / "spool") as damaged:
        damaged.execute("UPDATE sample SET said = substr(said, 1, 20) WHERE id = 2")
        damaged.execute("UPDATE sample SET said = CAST(x'7bff7d' AS TEXT) WHERE id = 4")
    damaged.close()
    spool = Spool(tmp_path / "spool", to="here")
    assert times(spool.next(9, live_after=0)) == [0, 2, 4]
    assert len(spool) == 3
    assert [line["reason"] for line in quarantined(tmp_path)] == ["It cannot be read any more."] * 2
    spool.close()


def test_a_log_that_a_full_disk_cut_off_loses_what_was_put_in_last_alone(spool, tmp_path):
    for minute in range(5):
        put(spool, sample(minute), place=str(minute))
    for name in ("spool", "spool-wal"):
        shutil.copy(tmp_path / name, tmp_path / f"cut-{name}")
    log = tmp_path / "cut-spool-wal"
    with log.open("r+b") as file:
        file.truncate(log.stat().st_size - 100)
    after = Spool(tmp_path / "cut-spool", to="here")
    assert times(after.next(9, live_after=0)) == [0, 1, 2, 3]
    assert after.place("file") == "3", "the source is read again from there"
    after.close()


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


def test_a_file_that_is_no_spool_is_reported(tmp_path):
    (tmp_path / "spool").write_text("time,depth_m\n" * 100)
    with pytest.raises(SpoolError, match="does not open as a spool"):
        Spool(tmp_path / "spool", to="here")


WRITER = """
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path
from seacage.records import Sample
from seacage.service._publish._spool import Spool
spool, t = Spool(Path(sys.argv[1]), to="here"), datetime(2020, 2, 1, tzinfo=UTC)
number = int(spool.place("file") or 0)
while True:
    number += 1
    one = Sample(stream="depth-2", t=t + timedelta(seconds=number), values={"depth_m": 1.0})
    spool.put([one], source="file", place=str(number))
    print(number, flush=True)
"""


def test_a_kill_loses_nothing_that_was_put_in_and_repeats_nothing(tmp_path):
    answer = 0
    for _ in range(3):
        command = [sys.executable, "-c", WRITER, str(tmp_path / "spool")]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            for _ in range(20):
                answer = json.loads(process.stdout.readline())
            process.send_signal(signal.SIGKILL)
    spool = Spool(tmp_path / "spool", to="here")
    number = int(spool.place("file"))
    assert number >= answer >= 60
    assert len(spool) == number
    spool.close()
