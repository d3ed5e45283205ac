"""Room for alarms: held, given up, and held again only where there is more to spare."""

import pytest

from disks import filled, small_disk
from seacage.service._store._database._reserve import Reserve
from seacage.service._store._database._session import FullError

SIZE = 1 << 20


@pytest.fixture
def path(tmp_path):
    return tmp_path / "samples.sqlite-reserve"


def test_what_is_held_is_room_on_the_disk_and_no_hole(path):
    Reserve(path, size=SIZE).hold()
    assert path.stat().st_size == SIZE
    assert path.stat().st_blocks * 512 >= SIZE


def test_what_a_killed_process_left_is_taken_over(path):
    path.write_bytes(b"old")
    reserve = Reserve(path, size=SIZE)
    reserve.hold()
    assert path.stat().st_size == SIZE
    reserve.give_up()
    reserve.give_up()
    assert not path.exists()


def test_a_fault_that_is_no_want_of_room_is_left_to_those_who_write(tmp_path):
    (tmp_path / "file").write_text("")
    Reserve(tmp_path / "file" / "reserve", size=SIZE).hold()


def test_it_is_held_only_where_there_is_twice_as_much_and_stays_when_there_is_not(tmp_path):
    with small_disk(tmp_path / "disk", size="8m") as disk:
        with pytest.raises(FullError, match="not 10 MiB free"):
            Reserve(disk / "reserve", size=5 << 20).hold()
        assert list(disk.iterdir()) == []
        reserve = Reserve(disk / "reserve", size=3 << 20)
        reserve.hold()
        with filled(disk):
            Reserve(disk / "reserve", size=3 << 20).hold()  # as after a kill
            reserve.give_up()
            with pytest.raises(FullError, match="free the disk"):
                reserve.hold()
            assert not (disk / "reserve").exists()
        reserve.hold()
        assert (disk / "reserve").stat().st_size == 3 << 20
