import asyncio
from datetime import UTC, datetime
from types import SimpleNamespace

import pytest
from structlog.testing import capture_logs

from running_service import HandClock
from seacage.conventions import RecordError
from seacage.records import ColumnMap
from seacage.service._ingest._file_feed import FileTail
from seacage.service._live._cage import LiveCage
from seacage.service._live._metrics import Metrics
from seacage.service._quarantine import Quarantine
from seacage.service._store._store import StoreError, open_store
from seacage.service._tail import Tail, TailPosition
from seacage.testing import stand_in_twin

HEADER = "time,current_speed_m_s,current_to_deg\n"
MAP = """
title = "Logger"
origin = "measured"
skip_lines = 1
delimiter = ";"
decimal = ","
encoding = "latin-1"
ignored = ["Spannung °"]

[time]
column = "Zeit"
format = "%d.%m.%Y %H:%M"
zone = "+01:00"

[columns.v]
quantity = "current_speed"
unit = "cm/s"

[columns.r]
quantity = "current_direction"
unit = "deg"
sense = "from"
"""


def row(minute, speed=0.5):
    return f"2020-02-01T11:{minute:02d}:00Z,{speed},90\n"


@pytest.fixture
def logger(tmp_path):
    """A growing file and its tail."""
    path, refused = tmp_path / "logger.csv", []

    def tail(**how):
        return Tail(path=path, refuse=lambda *what: refused.append(what), **how)

    def write(text, mode="a"):
        with path.open(mode, encoding="utf-8", newline="") as file:
            file.write(text)

    tails = []

    def made(**how):
        tails.append(tail(**how))
        return tails[-1]

    yield SimpleNamespace(path=path, refused=refused, tail=made, write=write)
    for one in tails:
        one.close()


def minutes(samples):
    return [sample.t.minute for sample in samples]


def test_rows_are_read_as_they_are_appended(logger):
    tail = logger.tail()
    assert tail.poll() == (), "the file may come later"
    logger.write(HEADER)
    assert tail.poll() == ()
    logger.write(row(0) + row(1))
    (first, _) = tail.poll()
    assert first.stream == "buoy-1"
    assert first.t == datetime(2020, 2, 1, 11, tzinfo=UTC)
    assert first.values == {"current_speed_m_s": 0.5, "current_to_deg": 90.0}
    assert tail.poll() == ()
    logger.write(row(2))
    assert minutes(tail.poll()) == [2]


def test_a_row_counts_once_its_line_has_ended(logger):
    tail = logger.tail()
    logger.write(HEADER + row(0) + row(1)[:-5])
    assert minutes(tail.poll()) == [0]
    assert tail.poll() == ()
    logger.write(row(1)[-5:])
    assert minutes(tail.poll()) == [1]


def test_line_ends_of_windows_are_line_ends(logger):
    tail = logger.tail()
    logger.write((HEADER + row(0) + row(1)).replace("\n", "\r\n"))
    assert minutes(tail.poll()) == [0, 1]


def test_a_bad_row_is_refused_with_its_line_and_the_others_are_not(logger):
    tail = logger.tail()
    logger.write(HEADER + row(0) + "yesterday,1,2\n" + row(1) + "1,2\n" + row(2))
    assert minutes(tail.poll()) == [0, 1, 2]
    assert [where for where, _, _ in logger.refused] == [
        f"{logger.path}, line 3",
        f"{logger.path}, line 5",
    ]
    assert "line 3: time = 'yesterday' is no time" in logger.refused[0][2]
    assert "2 cells in a table of 3" in logger.refused[1][2]


def test_a_header_that_nobody_knows_stops_the_tail_and_loses_no_row(logger):
    tail = logger.tail()
    logger.write("when,what\n" + row(0))
    with pytest.raises(RecordError, match="no shipped column map"):
        tail.poll()
    assert tail.place == TailPosition()
    assert not logger.refused


def test_after_a_rotation_the_old_file_is_read_to_its_end_and_then_the_new_one(logger):
    tail = logger.tail()
    logger.write(HEADER + row(0))
    tail.poll()
    logger.write(row(1) + "2020-02-01T11:02:00Z,0.")
    logger.path.rename(logger.path.with_suffix(".1"))
    logger.write(HEADER + row(3))
    assert minutes(tail.poll()) == [1]
    assert minutes(tail.poll()) == [3]
    ((_, rest, why),) = logger.refused
    assert rest == b"2020-02-01T11:02:00Z,0."
    assert "may be cut" in why


def test_a_file_that_was_cut_to_nothing_begins_anew(logger):
    tail = logger.tail()
    logger.write(HEADER + row(0) + row(1) + row(2))
    tail.poll()
    logger.write(HEADER + row(3), mode="w")
    assert minutes(tail.poll()) == [3]


def test_a_file_that_was_written_anew_and_is_longer_now_is_known_by_its_head(logger):
    tail = logger.tail()
    logger.write(HEADER + row(0))
    tail.poll()
    logger.write(HEADER + row(10) + row(11) + row(12), mode="w")
    assert minutes(tail.poll()) == [10, 11, 12]


def test_after_a_restart_it_reads_on_where_it_was(logger):
    logger.write(HEADER + row(0) + row(1))
    first = logger.tail()
    first.poll()
    logger.write(row(2))
    second = logger.tail(place=TailPosition.parse(str(first.place)))
    assert minutes(second.poll()) == [2]
    assert second.poll() == ()


@pytest.mark.parametrize("text", ["", "7", "{}", '{"offset": 3, "nonsense": 1}', "\0"])
def test_a_place_that_cannot_be_read_is_the_beginning(text):
    assert TailPosition.parse(text) == TailPosition()


def test_a_map_says_what_the_columns_mean(logger):
    tail = logger.tail(columns=ColumnMap.from_toml(MAP), stream="buoy-2")
    text = "Logger 7\nZeit;v;r;Spannung °\n01.02.2020 12:05;51,5;270;3\n"
    logger.path.write_bytes(text.encode("latin-1"))
    (sample,) = tail.poll()
    assert sample.stream == "buoy-2"
    assert sample.t == datetime(2020, 2, 1, 11, 5, tzinfo=UTC)
    assert sample.values["current_speed_m_s"] == pytest.approx(0.515)
    assert sample.values["current_to_deg"] == pytest.approx(90.0)


def test_a_map_in_utf_16_is_refused(logger):
    columns = ColumnMap.from_toml(MAP.replace("latin-1", "utf-16"))
    logger.write("a\nb\nc\n")
    with pytest.raises(RecordError, match="UTF-16 cannot be read in parts"):
        logger.tail(columns=columns).poll()


@pytest.fixture
def cage(tmp_path):
    store = open_store(tmp_path / "samples.sqlite")
    yield LiveCage(
        name="ace", twin=stand_in_twin(), store=store, clock=HandClock(), metrics=Metrics()
    )
    store.close()


def feed(cage, logger, tmp_path):
    return FileTail(
        logger.path,
        cage,
        quarantine=Quarantine(tmp_path / "quarantine.jsonl"),
        kept=tmp_path / "place.json",
        every_s=0.02,
    )


def run_until(tail, done):
    async def work():
        task = asyncio.create_task(tail.run())
        for _ in range(1000):
            if done():
                break
            await asyncio.sleep(0.02)
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)

    asyncio.run(work())
    assert done()


def test_a_growing_file_feeds_a_cage_also_after_a_restart(cage, logger, tmp_path):
    stored = lambda: minutes(cage.store.samples("ace", limit=100))  # noqa: E731
    logger.write(HEADER + row(0) + row(1))
    run_until(feed(cage, logger, tmp_path), lambda: stored() == [0, 1])
    logger.write("nonsense\n" + row(2))
    run_until(feed(cage, logger, tmp_path), lambda: stored() == [0, 1, 2])
    assert (tmp_path / "quarantine.jsonl").read_text().count("\n") == 1


def test_rows_that_the_disk_does_not_take_are_read_again(cage, logger, tmp_path, monkeypatch):
    take, refusals = cage.take, []

    async def refusing(samples):
        if len(refusals) < 3:
            refusals.append(tail.fault)
            raise StoreError("The disk is full.")
        return await take(samples)

    monkeypatch.setattr(cage, "take", refusing)
    logger.write(HEADER + row(0))
    tail = feed(cage, logger, tmp_path)
    run_until(tail, lambda: len(cage.store.samples("ace", limit=9)) == 1)
    assert refusals == [None, "The disk is full.", "The disk is full."]


def test_a_place_that_a_full_disk_cut_off_is_reported_and_the_file_read_anew(
    cage, logger, tmp_path
):
    logger.write(HEADER + row(0) + row(1))
    (tmp_path / "place.json").write_bytes(b'{"offset": 12, "he\xff')
    with capture_logs() as logs:
        tail = feed(cage, logger, tmp_path)
    assert "place cannot be read" in logs[0]["event"]
    run_until(tail, lambda: minutes(cage.store.samples("ace", limit=100)) == [0, 1])


HEADLESS = """
title = "No header"
origin = "measured"
header = false
skip_lines = {skip}
ignored = [3]

[time]
column = 1
format = "iso"
zone = "Europe/Oslo"

[columns.2]
quantity = "current_speed"
unit = "m/s"
"""


@pytest.mark.parametrize("skip", [0, 2])
def test_rows_of_a_file_without_a_header_are_followed_from_the_first(logger, skip):
    columns = ColumnMap.from_toml(HEADLESS.format(skip=skip))
    logger.write("above\n" * skip + "2020-02-01T11:00,0.1,x\n")
    tail = logger.tail(columns=columns)
    assert minutes(tail.poll()) == [0]
    logger.write("2020-02-01T11:10,0.2,x\n2020-02-01T11:20,0.3\n2020-02-01T11:30,0.4,x\n")
    assert minutes(tail.poll()) == [10, 30]
    assert [where for where, _, _ in logger.refused] == [f"{logger.path}, line {skip + 3}"]
    after = logger.tail(columns=columns, place=tail.place)
    logger.write("2020-02-01T11:40,0.5,x\n")
    (last,) = after.poll()
    assert last.t == datetime(2020, 2, 1, 10, 40, tzinfo=UTC)


def test_a_file_without_a_header_that_does_not_fit_its_map_stops_the_tail(logger):
    logger.write("2020-02-01T11:00,0.1\n")
    tail = logger.tail(columns=ColumnMap.from_toml(HEADLESS.format(skip=0)))
    with pytest.raises(RecordError, match="expects '3'"):
        tail.poll()


def test_rows_of_the_repeated_hour_are_followed_where_one_look_shows_the_step_back(logger):
    tail = logger.tail(columns=ColumnMap.from_toml(HEADLESS.format(skip=0)))
    rows = [f"2020-10-25T02:{minute:02}:00,0.1,x\n" for minute in range(0, 60, 10)]
    logger.write("".join(rows))
    assert tail.poll() == ()
    assert len(logger.refused) == 6
    assert "nothing tells summer time from standard time" in logger.refused[0][2]
    logger.write("".join([*rows, *rows]))
    assert [sample.t.hour for sample in tail.poll()] == [0] * 6 + [1] * 6
