from collections import Counter

from seacage.service._assembly import worker_of

CAGES = [f"cage-{number}" for number in range(400)]


def test_every_cage_has_one_worker_whatever_the_order():
    workers = ["a", "b", "c"]
    assert all(worker_of(cage, workers) in workers for cage in CAGES)
    assert all(worker_of(c, workers) == worker_of(c, workers[::-1]) for c in CAGES)


def test_the_work_is_shared_evenly():
    counts = Counter(worker_of(cage, ["a", "b", "c", "d"]) for cage in CAGES)
    # Binomial with mean 100 and standard deviation 8.7: five of them.
    assert all(abs(count - 100) < 44 for count in counts.values())


def test_a_worker_that_leaves_moves_its_own_cages_only():
    before, after = ["a", "b", "c", "d"], ["a", "b", "d"]
    for cage in CAGES:
        if worker_of(cage, before) != "c":
            assert worker_of(cage, after) == worker_of(cage, before)


def test_the_hash_is_the_same_in_every_version():
    # Workers of two versions may run side by side during an update; typed in from the first.
    assert [worker_of(cage, ["a", "b", "c"]) for cage in CAGES[:6]] == list("bbcaaa")
