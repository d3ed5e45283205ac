"""From settings and twins to a service: its store, cages, guard and feeds put together."""

from collections.abc import Callable, Coroutine, Iterator, Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING

import structlog

from seacage.conventions import InputError
from seacage.service._auth._audit import Audit
from seacage.service._auth._token_store import Tokens
from seacage.service._http._api import Service, create_app
from seacage.service._ingest._file_feed import FileTail
from seacage.service._ingest._mqtt_feed import MqttFeed
from seacage.service._live._cage import LiveCage
from seacage.service._live._clock import AbstractClock, FollowingClock, ReplayClock, WallClock
from seacage.service._live._metrics import Metrics
from seacage.service._live._replay import Replay
from seacage.service._live._retention import retire_old_days
from seacage.service._live._twin_shelf import TwinShelf
from seacage.service._publish._opcua_server import OpcUaServer
from seacage.service._publish._webhooks import WebhookNotifier
from seacage.service._quarantine import Quarantine
from seacage.service._settings import CageSection, Settings
from seacage.service._store._store import Store, open_store
from seacage.twin import AlarmPolicy, Twin, read_key

_log = structlog.get_logger(__name__)

if TYPE_CHECKING:
    import uvicorn

Feed = Callable[[], Coroutine[None, None, None]]


def read_twins(settings: Settings) -> dict[str, Twin]:
    """Read the twin of each cage that this worker serves, by the name under which it does.

    Raises InputError: there is a key for twins, and it cannot be used.
    Raises ModelError: a folder is no twin's, changed by as little as a byte or not signed by the
    key, and none was served before.
    """
    shelf = twin_shelf(settings)
    return dict(shelf.choose(one.name, one.twin) for one in own_cages(settings))


def twin_shelf(settings: Settings) -> TwinShelf:
    """Where the twins of cages are kept. Raises InputError: as for ``read_twins``."""
    key = read_key(settings.twin_key) if settings.twin_key else None
    return TwinShelf(settings.data, key=key)


def own_cages(settings: Settings) -> tuple[CageSection, ...]:
    """The cages that fall to this worker."""
    if settings.workers == 1:
        return settings.cages
    workers = [str(number) for number in range(settings.workers)]
    own = str(settings.worker)
    return tuple(one for one in settings.cages if worker_of(one.name or "", workers) == own)


def worker_of(cage: str, workers: Sequence[str]) -> str:
    """The one worker of a cage, the same in every process.

    When a worker comes or goes, only the cages that it gets or had move.

    ``workers``: the names of all workers, in any order; at least one.

    Source: Thaler & Ravishankar (1998), Using name-based mappings to increase hit rates: the
    highest random weight.
    """

    def weight(worker: str) -> tuple[bytes, str]:
        return blake2b(f"{cage}\n{worker}".encode(), digest_size=8).digest(), worker

    return max(workers, key=weight)


def policy_of(settings: Settings, name: str, twin: Twin) -> AlarmPolicy:
    """Take the limits of a cage's alarms from ``[alarms]`` and from its own table.

    Raises InputError: a limit for an alarm that there cannot be, or one that makes no sense.
    """
    own = [cage.alarms for cage in settings.cages if (cage.name or twin.cage.name) == name]
    table = {**settings.alarms, **(own[0] if own else {})}
    return AlarmPolicy.from_dict(table, twin.cage, buoy=twin.buoy, timeouts=twin.timeouts)


def store_place(settings: Settings, *, replayed: bool = False) -> Path | str:
    """Where the samples lie.

    What is replayed lies apart: it is forgotten at each start, what was measured never is.
    """
    if settings.store.url is None or replayed:
        return settings.data / ("replay.sqlite" if replayed else "samples.sqlite")
    return settings.store.url if "://" in settings.store.url else Path(settings.store.url)


def assemble(
    settings: Settings,
    twins: Mapping[str, Twin],  # of its cages, by name
    *,
    # What feeds its one cage, and how fast against real time
    replay: Replay | None = None,
    speed: float = 60.0,
) -> Service:
    """Put a service together; it does not run yet.

    Raises InputError: a replay for more than one cage, or settings that cannot be.
    Raises StoreError: the store does not open, or another process serves one of the cages from it.
    """
    if replay is not None and len(twins) != 1:
        raise InputError(f"serve: a record is replayed into one cage, and there are {len(twins)}.")
    _check_group(settings)
    for name, twin in twins.items():
        policy_of(settings, name, twin)  # refused before anything is opened
    store = open_store(
        store_place(settings, replayed=replay is not None),
        archive=settings.store.archive if replay is None else None,
    )
    with ExitStack() as on_failure:
        on_failure.callback(store.close)
        metrics, clock = Metrics(), _clock(settings, store, tuple(twins), replay, speed)
        cages = {
            name: LiveCage(
                name=name,
                twin=twin,
                store=store,
                clock=clock,
                metrics=metrics,
                tick_s=settings.tick_s,
                policy=partial(policy_of, settings, name),
                least_volume=settings.least_volume,
                shelf=twin_shelf(settings) if replay is None else None,
            )
            for name, twin in twins.items()
        }
        tokens = Tokens(settings.data)
        feeds = _feeds(settings, cages, metrics)
        if (opcua := settings.opcua) is not None:
            admits = partial(_reads_all, tokens, settings.site, tuple(cages))
            feeds.append(OpcUaServer(cages, opcua, admits).run)
        keep_days = settings.store.keep_days
        if replay is None and keep_days is not None:
            clocks = dict.fromkeys(cages, clock)
            feeds.append(partial(retire_old_days, store, clocks=clocks, keep_days=keep_days))
        if replay is not None and isinstance(clock, ReplayClock):
            feeds.append(partial(replay.feed, next(iter(cages.values())), clock))
        service = Service(
            cages=cages,
            store=store,
            tokens=tokens,
            metrics=metrics,
            feeds=feeds,
            limits=settings.limits,
            site=settings.site,
            audit=Audit(settings.data / "audit.jsonl"),
        )
        on_failure.pop_all()
    return service


def server(service: Service, settings: Settings) -> "uvicorn.Server":
    """Put a service behind HTTP, with a time and a bound for whoever connects."""
    import uvicorn

    from seacage.service._auth._protocols import LimitedHttp, LimitedSocket

    config = uvicorn.Config(
        create_app(service),
        http=LimitedHttp,
        ws=LimitedSocket,
        ws_max_size=4096,  # clients only send their token
        log_config=None,
        access_log=False,
        server_header=False,
        backlog=128,  # so many are taken at once, before any is counted
        forwarded_allow_ips=list(settings.trusted_proxies),
        timeout_graceful_shutdown=3,
        ssl_certfile=settings.certificate,
        ssl_keyfile=settings.key,
    )
    return uvicorn.Server(config)


def _reads_all(tokens: Tokens, site: str, cages: Sequence[str], token: str) -> bool:
    """Whether a token may read every cage."""
    grant = tokens.grant(token)
    return grant is not None and all(grant.allows("read", cage, site=site) for cage in cages)


def _check_group(settings: Settings) -> None:
    shares = settings.mqtt is not None and settings.mqtt.group is not None
    if shares and isinstance(store_place(settings), Path):
        raise InputError(
            "serve: the processes of an mqtt.group share a site's samples, and with SQLite each "
            "would keep a part of them. Give all one PostgreSQL as store.url, or leave group out."
        )


def _clock(
    settings: Settings, store: Store, cages: tuple[str, ...], replay: Replay | None, speed: float
) -> AbstractClock:
    if replay is not None:
        return ReplayClock(replay.start, speed=speed)
    if settings.clock == "wall":
        return WallClock()
    known = [sample.t for cage in cages for sample in store.latest(cage).values()]
    return FollowingClock(speed=settings.speed, newest=max(known, default=None))


def _feeds(settings: Settings, cages: Mapping[str, LiveCage], metrics: Metrics) -> list[Feed]:
    hooks = settings.webhooks
    feeds: list[Feed] = [WebhookNotifier(hooks, cages).run] if hooks else []
    quarantine = Quarantine(settings.data / "quarantine.jsonl")
    metrics.quarantined.set_function(lambda: float(quarantine.count))
    feeds += _tails(settings, cages, quarantine)
    if (mqtt := settings.mqtt) is not None:
        feed = MqttFeed(
            **mqtt.model_dump(exclude={"client_id"}),
            site=settings.site,
            cages=cages,
            client_id=mqtt.client_id or f"seacage-{settings.site}-{settings.worker}",
            metrics=metrics,
            quarantine=quarantine,
        )
        feeds.append(feed.run)
    return feeds


def _tails(
    settings: Settings, cages: Mapping[str, LiveCage], quarantine: Quarantine
) -> Iterator[Feed]:
    for section in own_cages(settings):
        cage = cages[section.name or next(iter(cages))]  # a cage without a name is alone
        for number, tail in enumerate(section.tail, start=1):
            kept = settings.data / "tails" / f"{cage.name}-{number}.json"
            kept.parent.mkdir(parents=True, exist_ok=True)
            feed = FileTail(tail.path, cage, quarantine=quarantine, stream=tail.stream, kept=kept)
            yield feed.run
