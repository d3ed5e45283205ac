import threading
import time
from datetime import UTC, datetime, timedelta

import pytest

from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._wires._mqtt_messages import Settled
from seacage.service._wires._publisher import Batch, Publisher
from seacage.service._wires._sender import SendError
from seacage.service._wires._spool import Spool

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


class Service:
    """Takes what is sent, unless it is away."""

    def __init__(self):
        self.had, self.sizes, self.away = [], [], 0

    def send(self, samples):
        self.sizes.append(len(samples))
        if self.away:
            self.away -= 1
            time.sleep(0.01)
            return []
        self.had += [(one.t - NOON) // timedelta(minutes=1) for one in samples]
        return [
            Settled(
                stream=one.stream,
                t=one.t,
                seq=one.seq,
                rejected="Too deep." if one.values["depth_m"] > 99.0 else None,
            )
            for one in samples
        ]

    def close(self):
        pass


def batch(*minutes, metres=14.0):
    samples = tuple(
        Sample(stream="depth-2", t=NOON + timedelta(minutes=m), values={"depth_m": metres})
        for m in minutes
    )
    return Batch(samples=samples, source="file", place=str(minutes[-1]))


@pytest.fixture
def spool(tmp_path):
    one = Spool(tmp_path / "spool", to="here", most=50)
    yield one
    one.close()


def test_a_source_is_sent_to_its_end(spool):
    done = Publisher(spool, service := Service()).run([batch(0, 1), batch(2)])
    assert sorted(service.had) == [0, 1, 2]
    assert (done.read, done.acknowledged, done.waiting) == (3, 3, 0)


def test_what_the_service_refuses_is_told_and_not_sent_again(spool):
    done = Publisher(spool, Service()).run([batch(0), batch(1, 2, metres=200.0)])
    assert (done.acknowledged, done.rejected, done.waiting) == (1, 2, 0)
    assert done.reasons == ("Too deep.", "Too deep.")


def test_while_the_service_is_away_one_sample_asks_for_it_and_then_live_ones_go_first(spool):
    service = Service()
    service.away = 5
    live = threading.Event()

    def source():
        yield batch(*range(20))
        while service.away > 2:
            time.sleep(0.005)
        yield batch(20)
        live.set()

    Publisher(spool, service).run(source())
    assert live.is_set()
    assert service.sizes[1:5] == [1, 1, 1, 1], "no more than one while nobody answers"
    assert service.had[0] == 20, "the newest first"
    assert sorted(service.had) == list(range(21))


def test_a_source_faster_than_the_service_fills_the_spool_and_waits(spool):
    service = Service()
    service.away = 20
    longest = []

    def source():
        for minute in range(200):
            longest.append(len(spool))
            yield batch(minute)

    done = Publisher(spool, service).run(source())
    assert max(longest) <= 50
    assert done.acknowledged == 200
    assert sorted(service.had) == list(range(200))


def test_patience_ends_and_the_samples_wait_for_the_next_run(spool):
    service = Service()
    service.away = 10**6
    with pytest.raises(SendError, match="3 samples wait in the spool"):
        Publisher(spool, service, patience_s=0.1).run([batch(0, 1, 2)])
    service.away = 0
    done = Publisher(spool, service).run([])
    assert (done.read, done.acknowledged) == (0, 3)


def test_a_source_that_fails_is_said_after_what_it_gave_has_arrived(spool):
    def source():
        yield batch(0)
        raise InputError("The file is no table.")

    service = Service()
    with pytest.raises(InputError, match="no table"):
        Publisher(spool, service).run(source())
    assert service.had == [0]
