import json
import os
import threading
import time
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import Origin
from seacage.records import Record
from seacage.service._publish._sources import (
    arriving,
    line_batches,
    pace,
    record_batches,
    tail_batches,
)
from seacage.service._tail import Tail

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


def record(stream, seconds):
    time = np.datetime64("2020-02-01T12:00:00", "us") + np.array(seconds) * np.timedelta64(1, "s")
    values = {"depth_m": np.full(len(seconds), 14.0)}
    return Record(stream=stream, time=time, values=values, origin=Origin.MEASURED)


RECORDS = [record("depth-1", [0, 10, 20]), record("depth-2", [5, 10, 15])]


def seconds(samples):
    return [(sample.t - NOON).total_seconds() for sample in samples]


def test_streams_are_merged_in_time_order():
    (batch,) = pace(RECORDS, speed=None)
    assert seconds(batch) == [0, 5, 10, 10, 15, 20]


def test_a_record_goes_at_a_multiple_of_real_time():
    began = time.monotonic()
    batches = list(pace(RECORDS, speed=100.0))
    # The last sample is due after 20 s / 100; a busy machine may only be later.
    assert time.monotonic() - began >= 0.2
    assert sum(map(len, batches)) == 6
    assert len(batches[0]) < 6


def test_a_record_is_read_on_from_its_place():
    (whole,) = record_batches(RECORDS, source="f", place=None, speed=None)
    (rest,) = record_batches(RECORDS, source="f", place=whole.samples[3].t.isoformat(), speed=None)
    assert seconds(rest.samples) == [10, 10, 15, 20], "those of one time are sent again"


def lines(*texts):
    refused = []
    batches = list(
        line_batches(
            [texts],
            refuse=lambda *what: refused.append(what),
        )
    )
    return [sample for batch in batches for sample in batch.samples], refused


def line(**changed):
    body = {"stream": "depth-2", "t": "2020-02-01T12:00:00Z", "values": {"depth_m": 14.2}}
    return json.dumps(body | changed).encode() + b"\n"


def test_each_line_is_a_sample():
    samples, refused = lines(line(), b"\n", line(seq=3, values={"depth_m": None}))
    assert [sample.seq for sample in samples] == [None, 3]
    assert not refused


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        (b"nonsense\n", "Invalid JSON"),
        (line(t="yesterday"), "t: "),
        (line(values={"tension": 3.0}), "has no quantity"),
        (line()[:-1], "ended inside this line"),
        (b"\xff\n", "Invalid JSON"),
    ],
)
def test_a_bad_line_is_refused_with_its_number_and_the_others_are_not(bad, reason):
    samples, ((where, row, why),) = lines(line(), bad, line(seq=1))
    assert len(samples) == 2
    assert (where, row) == ("line 2", bad)
    assert reason in why


def test_whether_a_samples_time_has_come_is_for_the_service_to_say():
    samples, refused = lines(line(t="2190-02-01T12:00:00Z"))
    assert len(samples) == 1
    assert not refused


def test_a_stream_that_is_no_name_is_refused():
    _, ((_, _, why),) = lines(line(stream="../net"))
    assert "no stream's name" in why


def test_lines_are_read_as_they_come():
    reader, writer = os.pipe()
    arrived = arriving(reader)
    os.write(writer, b"one\ntwo\nth")
    assert next(arrived) == [b"one\n", b"two\n"]
    os.write(writer, b"ree\nfour")
    assert next(arrived) == [b"three\n"]
    os.close(writer)
    assert list(arrived) == [[b"four"]]
    os.close(reader)


def test_a_growing_file_is_followed(tmp_path):
    path = tmp_path / "logger.csv"
    path.write_text("time,depth_m\n2020-02-01T12:00:00Z,14\n")
    tail = Tail(path=path, stream="depth-2", refuse=lambda *_: None)
    batches = tail_batches(tail, source="f", every_s=0.01)
    first = next(batches)
    assert seconds(first.samples) == [0]

    def later():
        with path.open("a") as file:
            file.write("2020-02-01T12:00:10Z,14\n")

    timer = threading.Timer(0.05, later)
    timer.start()
    assert seconds(next(batches).samples) == [10]
    timer.join()
    tail.close()
