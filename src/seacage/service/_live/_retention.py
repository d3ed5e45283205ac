"""How long samples stay at full rate: old days go to the archive, their aggregates stay."""

import asyncio
from collections.abc import Mapping
from datetime import timedelta

import structlog

from seacage.service._live._clock import AbstractClock, floor_time
from seacage.service._store._database._session import StoreError
from seacage.service._store._store import Store

_DAY = timedelta(days=1)
_log = structlog.get_logger(__name__)


async def retire_old_days(
    store: Store,  # where old samples are
    *,
    clocks: Mapping[str, AbstractClock],  # of each cage, as old is what its clock says
    # UTC days that ended longer ago leave [d]; above zero, as the settings say
    keep_days: float,
    every_s: float = 3600.0,  # between two looks [s of the wall]
) -> None:
    """Keep so many days of samples in the store, for ever; a feed of the service.

    A day leaves the store when it is archived, if the store has an archive, and its aggregates
    are final. The work goes in small pieces between those of the ingest. What fails is logged and
    tried again at the next look.
    """
    while True:
        for cage, clock in clocks.items():
            before = floor_time(clock.now() - timedelta(days=keep_days), _DAY)
            try:
                count = await asyncio.to_thread(store.retire, cage, before=before)
            except StoreError as error:
                _log.warning("old samples stay", cage=cage, reason=str(error))
            else:
                if count:
                    _log.info("old samples retired", cage=cage, samples=count)
        await asyncio.sleep(every_s)
