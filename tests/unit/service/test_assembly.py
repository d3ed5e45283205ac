import asyncio
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from seacage.conventions import InputError, ModelError
from seacage.records import Sample
from seacage.service._assembly import _reads_all, assemble, read_twins, store_place
from seacage.service._auth._token_store import Tokens
from seacage.service._live._replay import replay_of
from seacage.service._settings import Settings
from seacage.service._store._store import StoreError
from seacage.testing import stand_in_field, stand_in_twin


@pytest.fixture
def ended():
    """Services that a test puts together, ended after it."""
    services = []
    yield services
    for one in services:
        asyncio.run(one.end())


def settings_of(tmp_path, **settings):
    return Settings.model_validate({"data": tmp_path / "data"} | settings)


def test_cages_share_a_store_and_have_limits_of_their_own(tmp_path, ended):
    stand_in_twin().write(tmp_path / "twin")
    north = {"name": "north", "twin": tmp_path / "twin"}
    south = {"name": "south", "twin": tmp_path / "twin", "alarms": {"load": {"raise_at": 0.9}}}
    settings = settings_of(tmp_path, cages=[north, south], alarms={"load": {"raise_at": 0.75}})
    service = assemble(settings, read_twins(settings))
    ended.append(service)
    assert list(service.cages) == ["north", "south"]
    limits = [cage.desk.policy.limit("load.bridle-1").raise_at for cage in service.cages.values()]
    assert limits == [0.75, 0.9]
    assert len({id(cage.store) for cage in service.cages.values()}) == 1


def test_workers_part_the_cages_and_leave_none_out(tmp_path):
    stand_in_twin().write(tmp_path / "twin")
    cages = [{"name": f"cage-{k}", "twin": tmp_path / "twin"} for k in range(7)]
    served = [
        list(read_twins(settings_of(tmp_path, cages=cages, worker=worker, workers=2)))
        for worker in range(2)
    ]
    assert all(served)
    assert sorted(served[0] + served[1]) == [cage["name"] for cage in cages]


KEY = bytes(range(32))


@pytest.fixture
def keyed(tmp_path):
    """Settings with a key, and one cage of a twin that it signs."""
    stand_in_twin().write(tmp_path / "twin", key=KEY)
    (tmp_path / "key").write_bytes(KEY)
    (tmp_path / "key").chmod(0o600)
    cages = [{"name": "north", "twin": tmp_path / "twin"}]
    return settings_of(tmp_path, cages=cages, twin_key=tmp_path / "key")


def test_where_there_is_a_key_an_unsigned_twin_is_refused(tmp_path, keyed):
    (tmp_path / "twin" / "manifest.hmac").unlink()
    with pytest.raises(ModelError, match="is not signed"):
        read_twins(keyed)


@pytest.mark.parametrize("key", [None, bytes(32)], ids=["unsigned", "of another key"])
def test_a_twin_that_is_refused_leaves_the_one_that_was_served_last(tmp_path, keyed, key):
    before = read_twins(keyed)["north"]
    other = replace(stand_in_twin(), buoy="buoy-2")
    other.write(tmp_path / "twin", key=key)
    served = read_twins(keyed)["north"]
    assert served.buoy == before.buoy == "buoy-1"
    assert served.provenance == before.provenance
    other.write(tmp_path / "twin", key=KEY)
    assert read_twins(keyed)["north"].buoy == "buoy-2"


def test_the_last_twin_too_must_be_signed(tmp_path, keyed):
    read_twins(keyed)
    for folder in (tmp_path / "twin", *(tmp_path / "data" / "twins").glob("[0-9a-f]*[0-9a-f]")):
        stand_in_twin().write(folder)
    with pytest.raises(ModelError, match=r"twins/\w+ is not signed"):
        read_twins(keyed)


def test_a_key_that_others_can_read_stops_the_start(tmp_path, keyed):
    (tmp_path / "key").chmod(0o644)
    with pytest.raises(InputError, match="chmod 600"):
        read_twins(keyed)


def test_a_folder_is_served_by_one_process(tmp_path, ended, monkeypatch):
    monkeypatch.setattr("seacage.service._store._store._PATIENCE_S", 0.3)
    settings = settings_of(tmp_path)
    ended.append(assemble(settings, {"ace": stand_in_twin()}))
    reserve = tmp_path / "data" / "samples.sqlite-reserve"
    for _ in range(2):
        with pytest.raises(StoreError, match="a folder of its own"):
            assemble(settings, {"ace": stand_in_twin()})
        assert reserve.exists(), "who was refused leaves what is the other's alone"


def test_a_group_takes_a_store_that_its_processes_share(tmp_path):
    settings = settings_of(tmp_path, mqtt={"url": "mqtt://127.0.0.1", "group": "twins"})
    with pytest.raises(InputError, match=r"one PostgreSQL as store\.url"):
        assemble(settings, {"ace": stand_in_twin()})


def test_a_clock_that_follows_goes_on_where_the_store_ends(tmp_path, ended):
    then = datetime(2018, 1, 26, tzinfo=UTC)
    settings = settings_of(tmp_path, clock="samples", speed=100.0)
    for speaks in (True, False):
        service = assemble(settings, {"ace": stand_in_twin()})
        cage = service.cages["ace"]
        if speaks:
            water = {"current_speed_m_s": 0.5, "current_to_deg": 90.0}
            asyncio.run(cage.take([Sample(stream="buoy-1", t=then, values=water)]))
            asyncio.run(service.end())
    ended.append(service)
    assert then <= cage.clock.now() < then + timedelta(days=1)
    assert cage.snapshot.state.valid


def test_a_table_that_grows_feeds_its_cage(tmp_path, ended):
    stand_in_twin().write(tmp_path / "twin")
    tail = {"path": tmp_path / "buoy.csv"}
    settings = settings_of(tmp_path, cages=[{"twin": tmp_path / "twin", "tail": [tail]}])
    service = assemble(settings, read_twins(settings))
    ended.append(service)
    (tmp_path / "buoy.csv").write_text(
        "time,current_speed_m_s,current_to_deg\n2020-02-01T12:00:00Z,0.5,90\n"
    )
    (cage,) = service.cages.values()

    async def fed():
        feeds = [asyncio.create_task(feed()) for feed in service._feeds]
        while not cage.store.samples(cage.name, limit=1):
            await asyncio.sleep(0.05)
        for feed in feeds:
            feed.cancel()

    asyncio.run(asyncio.wait_for(fed(), 20))


def test_what_is_replayed_lies_apart_from_what_was_measured(tmp_path):
    settings = settings_of(tmp_path, store={"url": "postgresql://db/farm"})
    assert store_place(settings) == "postgresql://db/farm"
    assert store_place(settings, replayed=True) == tmp_path / "data" / "replay.sqlite"
    assert store_place(settings_of(tmp_path)) == tmp_path / "data" / "samples.sqlite"


def test_a_record_is_not_replayed_into_several_cages(tmp_path):
    twin = stand_in_twin()
    buoy = stand_in_field(twin.cage, days=0.25).buoy
    with pytest.raises(InputError, match="there are 2"):
        assemble(settings_of(tmp_path), {"a": twin, "b": twin}, replay=replay_of(buoy))


@pytest.mark.parametrize(
    ("scopes", "reads"),
    [(["read"], True), (["admin"], True), (["read:site"], True), (["read:north"], False)],
)
def test_opc_ua_takes_a_token_that_reads_every_cage(tmp_path, scopes, reads):
    tokens = Tokens(tmp_path)
    token = tokens.mint(scopes, keep=False)
    assert _reads_all(tokens, "site", ("north", "south"), token) == reads
    assert not _reads_all(tokens, "site", ("north", "south"), "guess")


def test_opc_ua_is_served_beside_the_rest(tmp_path, ended):
    pytest.importorskip("asyncua")
    service = assemble(settings_of(tmp_path, opcua={}), {"ace": stand_in_twin()})
    ended.append(service)
    assert any("OpcUaServer" in feed.__qualname__ for feed in service._feeds)
