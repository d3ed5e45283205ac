"""Write the saved forms of seacage 0.1.0, and what 0.1.0 answered from them.

It was run once, at the last commit of 0.1.0, and is kept to say how ``0.1.0/`` came to be; later
sources have other names. The folder is read by ``tests/contracts/test_frozen.py``.

    python tests/frozen/make_0_1_0.py tests/frozen/0.1.0 "host=127.0.0.1 user=root dbname=test"
"""

import asyncio
import json
import math
import random
import shutil
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import (
    Hidden,
    Plan,
    Timetable,
    generated_current,
    run_campaign,
    virtual_field,
)
from seacage.ocean import SeaState
from seacage.records import Sample
from seacage.service._auth._sessions import Sessions
from seacage.service._auth._token_store import Tokens
from seacage.service._live._answers import state_of
from seacage.service._live._cage import LiveCage
from seacage.service._live._metrics import Metrics
from seacage.service._live._past import state_at
from seacage.service._mqtt._messages import Settled
from seacage.service._publish._spool import Spool
from seacage.service._schemas._samples import SampleOut
from seacage.service._store._store import Store, open_store
from seacage.testing import stand_in_field, stand_in_twin
from seacage.twin import Twin

NIGHT = datetime(2020, 1, 19, 21, tzinfo=UTC)  # a day and a half after the stand-in field begins
LIVE_H, TWIN_SPOKES = 15.0, 8
STUCK_H, SPIKE_H, GONE_H = (5.0, 11.0), 7.0, 12.0
WATERS = ((0.0, 0.0), (0.2, 75.0), (0.5, 10.0), (0.9, 200.0), (1.1, 330.0), (1.6, 75.0))
LOOKS_H = (2.0, 6.5, 10.0, 11.5, 14.0, LIVE_H)


class HandClock:
    """Stands still until it is moved."""

    speed = 1.0

    def __init__(self, at: datetime) -> None:
        self.at = at

    def now(self) -> datetime:
        return self.at


def main(folder: Path, server: str) -> None:
    """Write everything; ``server`` is a PostgreSQL where a schema may be made and dropped."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    expected: dict[str, Any] = {"version": "0.1.0"}
    twin = stand_in_twin(spokes=TWIN_SPOKES)
    twin.write(folder / "twin")
    expected["twin"] = answers_of(Twin.read(folder / "twin"))
    expected["store"] = asyncio.run(fill_store(folder, twin))
    expected["postgres"] = dump_postgres(folder / "store.sql", server, twin)
    expected["cage"] = write_cage(folder / "cage.toml")
    expected["campaign"] = write_campaign(folder / "campaign.zarr")
    expected["field"] = write_field(folder / "field")
    expected["tokens"] = write_tokens(folder / "access")
    expected["spool"] = write_spool(folder / "spool.sqlite")
    write_settings(folder / "seacage.toml")
    text = json.dumps(expected, separators=(",", ":"), default=str)
    (folder / "expected.json").write_text(text + "\n", encoding="utf-8")


# Twin, cage, campaign, field


def answers_of(twin: Twin) -> list[dict[str, Any]]:
    """Means of the answers to some currents, two of them beyond the training domain."""
    found = []
    for speed, to in (
        (0.0, 0.0),
        (0.2, 75.0),
        (0.5, 10.0),
        (0.9, 200.0),
        (1.1, 330.0),
        (1.6, 75.0),
    ):
        answer = twin.predict(SeaState(current_speed=speed, current_to=to))
        found.append(
            {
                "current_speed_m_s": speed,
                "current_to_deg": to,
                "in_domain": bool(answer.in_domain[0]),
                "bridle_n": answer.bridle_tension.mean[0].tolist(),
                "sensor": answer.sensor.mean[0].tolist(),
                "sensor_low": answer.sensor_low.mean[0].tolist(),
                "bottom_m": answer.node_position[0, -1].tolist(),
                "volume_fraction": float(answer.volume_fraction[0]),
            }
        )
    return found


def write_cage(path: Path) -> dict[str, Any]:
    """A cage that differs from those shipped in name, heading and mesh."""
    cage = replace(Cage.named("ace").altered(mesh={"spokes": 16}), name="frozen", heading=30.0)
    cage.write(path)
    return {"sha256": cage.sha256, "nodes": len(cage.design_position), "toml": cage.to_toml()}


def write_campaign(path: Path) -> dict[str, Any]:
    """A campaign in time."""
    cage = Cage.named("ace").altered(mesh={"spokes": 8})
    plan = Plan.sample(3, 6, duration=60.0, hs=(0.5, 2.0))
    plan.write(path.with_name("plan.json"))
    record = run_campaign(cage, plan, path, workers=1, spin_up=30.0, ramp=20.0, second_moment=False)
    return {
        "bridle_n": np.asarray(record.bridle_tension).tolist(),
        "bottom_m": np.asarray(record.node_position)[:, -1].tolist(),
    }


def write_field(folder: Path) -> dict[str, Any]:
    """Two hours of a virtual field in time, with the stretches it was made from."""
    cage = Cage.named("ace").altered(mesh={"spokes": 8})
    buoy = generated_current(5, start=datetime(2020, 1, 18, tzinfo=UTC), days=0.1)
    made = virtual_field(
        cage,
        buoy,
        hidden=Hidden.read(None),
        seed=5,
        every_s=60.0,
        timetable=Timetable(stretch=1800.0, spin_up=60.0, time_step=0.002, one_in=2),
        kept=folder / "stretches",
        workers=2,
    )
    made.write(folder)
    streams = {one.stream: one for one in (made.record.buoy, *made.record.sensors.values())}
    return {
        name: {
            "times": [str(t) for t in one.time[:3]],
            "count": len(one),
            "first": {key: numbers(column[:3]) for key, column in one.values.items()},
        }
        for name, one in streams.items()
    }


def numbers(column: np.ndarray) -> list[float | None]:
    """With None for what is missing."""
    return [value if math.isfinite(value) else None for value in column.tolist()]


# Store, alarms, archive


async def fill_store(folder: Path, twin: Twin) -> dict[str, Any]:
    """Run a live cage through a night: stuck, spiking, late, repeated, missing, silent."""
    archive = folder / "archive"
    store = open_store(folder / "store.sqlite", archive=archive)
    clock = HandClock(NIGHT)
    cage = LiveCage(name="ace", twin=twin, store=store, clock=clock, metrics=Metrics())
    shown, folded = {}, {}
    due = list(arrivals(twin))
    minutes = 0.0
    while minutes <= LIVE_H * 60.0:
        clock.at = NIGHT + timedelta(minutes=minutes)
        batch = [sample for at, sample in due if minutes - 2.0 < at <= minutes]
        if batch:
            await cage.take(batch)
        step(cage)
        if minutes == 60.0:
            await handle_first(cage)
        if any(minutes == 60.0 * look for look in LOOKS_H):
            shown[clock.at.isoformat()] = cage.snapshot.state.model_dump(mode="json")
        minutes += 2.0
    store.retire("ace", before=datetime(2020, 1, 20, tzinfo=UTC))
    for look in shown:
        at = datetime.fromisoformat(look)
        state, answered = state_at(twin, store, "ace", at)
        folded[look] = state_of("ace", twin, answered, state).model_dump(mode="json")
    alarms = cage.desk.alarms
    told = {
        "shown": shown,
        "folded": folded,
        "samples": [
            SampleOut.model_validate(one).model_dump(mode="json") for one in all_samples(store)
        ],
        "latest": {n: s.t.isoformat() for n, s in store.latest("ace").items()},
        "aggregates": aggregates_of(store),
        "alarms": {
            name: {"active": one.active, "acknowledged": one.acknowledged}
            for name, one in alarms.items()
            if one.since is not None
        },
        "journal": [
            {"t": one.t.isoformat(), "alarm": one.alarm, "action": one.action.value, "who": one.who}
            for one in store.journal("ace", limit=10_000)
        ],
        "adapted": json.loads(store.adapted("ace") or "{}"),
    }
    book = store.alarm_book("ace")
    assert book is not None
    (folder / "alarm_book.json").write_text(book + "\n", encoding="utf-8")
    await asyncio.sleep(0.5)  # the writer's chores
    store.close()
    for left in folder.glob("store.sqlite-*"):
        left.unlink()
    return told


def step(cage: LiveCage) -> None:
    """One round of ``LiveCage.run``."""
    samples = list(cage._pending)
    cage._pending.clear()
    answered, _ = cage._stepped(samples)
    cage._publish(answered)


async def handle_first(cage: LiveCage) -> None:
    """Shelve an alarm that there may be, for the journal to have what people did."""
    name = next(iter(cage.desk.alarms))
    await cage.handle(name, "comment", who="Night shift", why="frozen", seconds=None)


def arrivals(twin: Twin) -> Iterator[tuple[float, Sample]]:
    """Samples, and the minutes from the beginning at which they arrive."""
    draw = random.Random(1)
    field = stand_in_field(twin.cage, seed=4, days=2.6, buoy_s=720.0, sensor_s=600.0)
    for record in (field.buoy, *field.sensors.values()):
        number = 0
        for sample in record.between(NIGHT, NIGHT + timedelta(hours=LIVE_H)).samples():
            number += 1
            minute = (sample.t - NIGHT) / timedelta(minutes=1)
            one = mishap(replace(sample, seq=number), minute / 60.0)
            if one is None:
                continue
            late = draw.choice((0.0, 0.0, 0.0, 8.0, 90.0 if number % 40 == 0 else 0.0))
            yield minute + late, one
            if number % 17 == 0:
                yield minute + late + 2.0, one  # repeated


def mishap(sample: Sample, hour: float) -> Sample | None:
    """What goes wrong with a sample."""
    values = dict(sample.values)
    if sample.stream == "buoy-1" and STUCK_H[0] <= hour < STUCK_H[1]:
        values = {"current_speed_m_s": 0.41, "current_to_deg": 77.0}
    if sample.stream == "buoy-1":
        values |= {"hs_m": 0.8 + 0.05 * math.sin(hour), "tp_s": 5.0, "wave_from_deg": 250.0}
    if sample.stream == "depth-1" and abs(hour - SPIKE_H) < 0.05:
        values = {"depth_m": 25.0}
    if sample.stream == "depth-2" and 8.0 <= hour < 8.4:
        values = {"depth_m": math.nan}
    if sample.stream == "depth-3" and hour >= GONE_H:
        return None
    if sample.stream == "buoy-1" and 13.0 <= hour < 13.3:
        values["current_to_deg"] = 412.0
    return replace(sample, values=values)


def all_samples(store: Store) -> list[Sample]:
    """Every sample, archived ones with them."""
    return store.samples("ace", limit=100_000)


def aggregates_of(store: Store) -> dict[str, list[list[Any]]]:
    """Ten-minute aggregates of two quantities."""
    asked = (("buoy-1", "current_east_m_s"), ("depth-1", "depth_m"))
    return {
        f"{stream} {key}": [
            [one.t.isoformat(), one.count, one.mean, one.least, one.most]
            for one in store.aggregates("ace", stream=stream, key=key, width_s=600, limit=1000)
        ]
        for stream, key in asked
    }


def dump_postgres(path: Path, server: str, twin: Twin) -> dict[str, Any]:
    """Three hours in PostgreSQL, as ``pg_dump`` writes its schema."""
    import psycopg

    name = "frozen_0_1_0"
    with psycopg.connect(server, autocommit=True) as owner:
        owner.execute("SET client_min_messages = error")
        owner.execute(f"DROP SCHEMA IF EXISTS {name} CASCADE")
        owner.execute(f"CREATE SCHEMA {name}")
        parts = psycopg.conninfo.conninfo_to_dict(server)
        place = (
            f"postgresql://{parts['user']}@{parts['host']}/{parts['dbname']}"
            f"?options=-csearch_path%3D{name}"
        )
        store = open_store(place)
        clock = HandClock(NIGHT)
        cage = LiveCage(name="ace", twin=twin, store=store, clock=clock, metrics=Metrics())
        taken = [one for at, one in arrivals(twin) if at < 180.0]
        clock.at = NIGHT + timedelta(hours=3)
        asyncio.run(cage.take(sorted(taken, key=lambda one: one.t)))
        step(cage)
        wait(cage.store.keep_adapted("ace", cage._state.adapted))
        told = {
            "samples": [
                SampleOut.model_validate(one).model_dump(mode="json") for one in all_samples(store)
            ],
            "aggregates": aggregates_of(store),
            "shown": cage.snapshot.state.model_dump(mode="json"),
        }
        store.close()
        dumped = subprocess.run(
            ["pg_dump", "--no-owner", "--no-privileges", f"--schema={name}", server],
            check=True,
            capture_output=True,
            text=True,
        )
        owner.execute(f"DROP SCHEMA {name} CASCADE")
    path.write_text(dumped.stdout, encoding="utf-8")
    return told


def wait(done: "Future[None]") -> None:
    """Until it is on disk."""
    done.result(timeout=20)


# Tokens, spool, settings


def write_tokens(folder: Path) -> dict[str, Any]:
    """Three tokens, one of them revoked, and a session; they open nothing but this fixture."""
    folder.mkdir()
    tokens = Tokens(folder)
    minted = {
        "night": tokens.mint(["read", "ack"], keep=True, name="night"),
        "buoy": tokens.mint(["ingest:ace"], keep=True, name="buoy"),
        "gone": tokens.mint(["admin"], keep=True, name="gone"),
    }
    tokens.revoke("gone")
    begun = datetime(2020, 1, 1, tzinfo=UTC)
    grant = tokens.grant(minted["night"])
    assert grant is not None
    cookie, _ = Sessions(tokens, lasting_s=86_400.0).begin(grant, begun)
    return {
        "tokens": minted,
        "scopes": {grant.name: list(grant.scopes) for grant in tokens.all()},
        "cookie": cookie,
        "cookie_until": (begun + timedelta(days=1)).isoformat(),
    }


def write_spool(path: Path) -> dict[str, Any]:
    """A spool with samples that wait, and some that are settled."""
    to = "http://127.0.0.1:8000 ace"
    spool = Spool(path, to=to)
    samples = [
        Sample(
            stream="buoy-1",
            t=NIGHT + timedelta(seconds=2 * number),
            values={"current_speed_m_s": 0.1 * number, "current_to_deg": math.nan},
            seq=number if number % 2 else None,
        )
        for number in range(20)
    ]
    spool.put(samples, source="buoy.csv", place="row 20")
    spool.settle([Settled(stream=one.stream, t=one.t, seq=one.seq) for one in samples[:5]])
    spool.close()
    for left in path.parent.glob(path.name + "-*"):
        left.unlink()
    kept = [SampleOut.model_validate(one).model_dump(mode="json") for one in samples[5:]]
    return {"to": to, "place": "row 20", "waiting": kept}


def write_settings(path: Path) -> None:
    """The shipped settings with every line that is commented out taken in."""
    shipped = Path("packaging/seacage.toml").read_text("utf-8")
    lines = []
    for line in shipped.splitlines():
        bare = line.removeprefix("# ")
        setting = bare != line and (" = " in bare or bare.startswith("[")) and not bare[0].isupper()
        lines.append(bare if setting and bare.split()[0].strip("[]").islower() else line)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
