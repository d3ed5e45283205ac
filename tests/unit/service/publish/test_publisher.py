import threading
import time
from datetime import UTC, datetime, timedelta

import pytest

from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._mqtt._messages import Settled
from seacage.service._publish._publisher import Batch, Publisher
from seacage.service._publish._sender import SendError
from seacage.service._publish._spool import Spool

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


class Service:
    """Takes what is sent, unless it is away."""

    def __init__(self):
        self.had, self.sizes, self.away = [], [], 0
        self.clock = float("inf")  # minutes after noon that are not ahead of it
        self.tries = []

    def send(self, samples):
        self.sizes.append(len(samples))
        if self.away:
            self.away -= 1
            time.sleep(0.01)
            return []
        minutes = [(one.t - NOON) // timedelta(minutes=1) for one in samples]
        self.tries.append(minutes)
        self.had += [minute for minute in minutes if minute <= self.clock]
        return [
            Settled(stream=one.stream, t=one.t, seq=one.seq, rejected="It is ahead.", retry=True)
            if minute > self.clock
            else Settled(
                stream=one.stream,
                t=one.t,
                seq=one.seq,
                rejected="Too deep." if one.values["depth_m"] > 99.0 else None,
            )
            for one, minute in zip(samples, minutes, strict=True)
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
    assert (done.read, done.acknowledged, done.spooled) == (3, 3, 0)


def test_what_the_service_refuses_is_reported_and_not_sent_again(spool):
    done = Publisher(spool, Service()).run([batch(0), batch(1, 2, metres=200.0)])
    assert (done.acknowledged, done.rejected, done.spooled) == (1, 2, 0)
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


def test_a_source_that_fails_is_reported_after_what_it_gave_has_arrived(spool):
    def source():
        yield batch(0)
        raise InputError("The file is no table.")

    service = Service()
    with pytest.raises(InputError, match="no table"):
        Publisher(spool, service).run(source())
    assert service.had == [0]


def test_what_is_ahead_of_the_services_clock_waits_and_delays_nothing(spool):
    service = Service()
    service.clock = 2
    done = Publisher(spool, service).run([batch(0, 5), batch(1, 6), batch(2)])
    assert sorted(service.had) == [0, 1, 2]
    assert (done.acknowledged, done.rejected, done.ahead, done.spooled) == (3, 0, 2, 2)
    tried = [minute for minutes in service.tries for minute in minutes]
    assert sorted(tried) == [0, 1, 2, 5, 6], "within a minute, once"


def test_after_a_restart_what_was_ahead_is_tried_again_and_the_rest_waits_on(spool):
    service = Service()
    service.clock = 2
    Publisher(spool, service).run([batch(5, 6, 9)])
    service.clock = 6
    done = Publisher(spool, service).run([batch(1)])
    assert sorted(service.had) == [1, 5, 6]
    assert (done.acknowledged, done.ahead) == (3, 1)
    service.clock = 9
    assert Publisher(spool, service).run([]).acknowledged == 1
    assert len(spool) == 0


def test_what_was_ahead_goes_while_the_source_goes_on(spool):
    service = Service()
    service.clock = 2

    def source():
        yield batch(5, 6)
        while not spool.ahead:
            time.sleep(0.005)
        service.clock = 6
        while spool.ahead:
            time.sleep(0.005)
        yield batch(1)

    done = Publisher(spool, service, retry_s=0.0).run(source())
    assert sorted(service.had) == [1, 5, 6]
    assert done.acknowledged == 3


def test_what_stays_ahead_is_set_aside_with_the_reason(spool, tmp_path):
    service = Service()
    service.clock = 2
    done = Publisher(spool, service, keep_ahead=timedelta(0)).run([batch(1, 5)])
    assert (done.acknowledged, done.quarantined, done.spooled) == (1, 1, 0)
    assert "It is ahead." in (tmp_path / "spool.quarantine.jsonl").read_text()


def test_while_the_service_is_away_what_is_ahead_asks_for_it_too(spool):
    service = Service()
    service.clock = 2
    Publisher(spool, service).run([batch(5, 6, 7)])
    service.away, service.clock = 3, 9
    done = Publisher(spool, service).run([])
    assert service.sizes[-4:-1] == [1, 1, 1]
    assert done.acknowledged == 3
