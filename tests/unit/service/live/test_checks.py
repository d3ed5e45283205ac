"""What is remembered of a stream is what is on disk or on its way there, whatever fails."""

import random
from datetime import UTC, datetime, timedelta

from seacage.conventions import Flag
from seacage.records import QualityState, Sample, check_sample
from seacage.service._live._checks import Checks

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


def sample(minutes, metres, stream="depth-1"):
    t = NOON + timedelta(minutes=minutes)
    return Sample(stream=stream, t=t, values={"depth_m": metres})


def folded(samples):
    memory = {}
    for one in samples:
        memory[one.stream], _ = check_sample(memory.get(one.stream, QualityState()), one)
    return memory


def test_what_the_disk_refused_is_not_compared_with_when_it_comes_again():
    checks = Checks(folded([sample(0, 14.0)]))
    jump = sample(1, 24.0)
    first = checks.check([jump])
    assert first.samples[0].flags["depth_m"] != Flag.GOOD
    checks.forget(first)
    assert checks.check([jump]).samples == first.samples


def test_what_came_through_stays_remembered_though_what_was_asked_before_it_failed():
    checks = Checks({})
    lost, kept = checks.check([sample(0, 14.0)]), checks.check([sample(1, 14.1)])
    checks.forget(lost)
    checks.keep(kept)
    assert checks.check([]).before == folded([sample(1, 14.1)])


def test_a_failure_after_a_success_takes_nothing_with_it():
    checks = Checks({})
    lost, kept = checks.check([sample(0, 14.0)]), checks.check([sample(1, 14.1)])
    checks.keep(kept)
    checks.forget(lost)
    assert checks.check([]).before == folded([sample(1, 14.1)])


def test_whatever_fails_in_whatever_order_the_rest_is_remembered_and_nothing_piles_up():
    chance = random.Random(5)
    for _ in range(100):
        checks, under_way, alive, minutes = Checks({}), [], [], 0
        for _ in range(30):
            if under_way and chance.random() < 0.5:
                checked, batch = under_way.pop(chance.randrange(len(under_way)))
                if chance.random() < 0.5:
                    checks.forget(checked)
                    alive.remove(batch)
                else:
                    checks.keep(checked)
            else:
                minutes += 1
                stream = chance.choice(["depth-1", "depth-2"])
                batch = [sample(minutes, chance.uniform(10.0, 20.0), stream)]
                under_way.append((checks.check(batch), batch))
                alive.append(batch)
        for checked, _ in under_way:
            checks.keep(checked)
        assert not checks._asked
        assert checks.check([]).before == folded(one for batch in alive for one in batch)
