"""Alarms posted to other systems by webhook, at once or when nobody has acknowledged them."""

import asyncio
import hashlib
import hmac
from collections import deque
from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta

import structlog

from seacage.service._live._alarm_desk import Announcement, announcement_json
from seacage.service._live._cage import LiveCage
from seacage.service._publish._post import POST_FAILED, Webhook, post
from seacage.twin import Action

_ANNOUNCED = {Action.RAISED, Action.REPEATED, Action.CLEARED, Action.ACKNOWLEDGED}
_PATIENCE_S = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 60.0, 60.0, 60.0)
_LOOK_S = 0.5
_WAITING = 1000  # messages to one hook; the oldest is dropped, for the newest say how it stands
_TIMEOUT_S = 10.0
_log = structlog.get_logger(__name__)


class WebhookNotifier:
    """Tells webhooks what happens to the alarms of all cages.

    Each hook has its own queue, so that one that does not answer holds nobody up; a message is
    tried again for some minutes, in order, and then dropped with a line in the log.

    ``hooks`` and ``cages``: where to, and whose alarms.
    """

    def __init__(self, hooks: Sequence[Webhook], cages: Mapping[str, LiveCage]) -> None:
        self._cages = cages
        self._queues = {hook: deque[str](maxlen=_WAITING) for hook in hooks}
        # Since when each alarm stood that was escalated last: as many as there are alarms.
        self._escalated: dict[tuple[Webhook, str, str], datetime] = {}
        for cage in cages.values():
            cage.desk.subscribe(self._take)

    async def run(self) -> None:
        """Tell for ever."""
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self._escalate())
            for hook in self._queues:
                tasks.create_task(self._deliver(hook))

    def _take(self, announcement: Announcement) -> None:
        # Called in the thread that stepped the twin; a deque takes this without a lock.
        if announcement.happened.quiet or announcement.happened.action not in _ANNOUNCED:
            return
        for hook, queue in self._queues.items():
            if hook.after_s == 0.0 and hook.wants(announcement.cage, announcement.severity):
                queue.append(announcement_json(announcement))

    async def _escalate(self) -> None:
        while True:
            await asyncio.sleep(_LOOK_S)
            for hook in self._queues:
                if hook.after_s > 0.0:
                    self._overdue(hook)

    def _overdue(self, hook: Webhook) -> None:
        for name, cage in self._cages.items():
            due = cage.clock.now() - timedelta(seconds=hook.after_s)
            for announcement in cage.desk.standing():
                key, since = (hook, name, announcement.alarm.name), announcement.alarm.since
                if since is None or since > due or self._escalated.get(key) == since:
                    continue
                if hook.wants(name, announcement.severity):
                    self._escalated[key] = since
                    self._queues[hook].append(announcement_json(announcement, action="escalated"))

    async def _deliver(self, hook: Webhook) -> None:
        queue = self._queues[hook]
        while True:
            if not queue:
                await asyncio.sleep(_LOOK_S)
                continue
            body = queue.popleft()
            problem: str | None = ""
            for pause_s in (0.0, *_PATIENCE_S):
                await asyncio.sleep(pause_s)
                problem = await asyncio.to_thread(_post_once, hook, body)
                if problem is None:
                    break
            else:
                _log.error("webhook gives up", url=hook.url, reason=problem, body=body)


def _post_once(hook: Webhook, body: str) -> str | None:
    """Post once; why it failed, or None."""
    headers = dict[str, str]()
    if hook.secret:
        signature = hmac.new(hook.secret.encode(), body.encode(), hashlib.sha256)
        headers["X-Seacage-Signature"] = signature.hexdigest()
    try:
        status, _ = post(hook.url, body, headers=headers, timeout_s=_TIMEOUT_S)
    except POST_FAILED as error:
        return str(error) or type(error).__name__
    return None if 200 <= status < 300 else f"it answered {status}"
