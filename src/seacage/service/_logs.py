"""Structured logs: one event per line, for people or for machines."""

import logging
import sys
import time
from collections import Counter
from typing import Literal, cast

import structlog

from seacage.service._auth._limits import Rates


class _Repeats(logging.Filter):
    """Let the first hundred lines of a kind pass and one in five seconds; count the others."""

    def __init__(self) -> None:
        super().__init__()
        self._rates, self._left_out = Rates(per_s=0.2, burst=100.0), Counter[str]()

    def filter(self, record: logging.LogRecord) -> bool:
        line = cast(object, record.msg)  # structlog's is a mapping
        event = cast(dict[str, object], line) if isinstance(line, dict) else {"event": line}
        kind = f"{record.name} {event.get('event')}"[:100]
        if self._rates.wait_s(kind, time.monotonic()):
            self._left_out[kind] += 1
            return False
        if left_out := self._left_out.pop(kind, 0):
            more = f"{event.get('event')} ({left_out} more like it were not written)"
            record.msg = event | {"event": more} if isinstance(line, dict) else more
        return True


def begin_logs(form: Literal["lines", "json"]) -> None:
    """Send what seacage and uvicorn say to stderr.

    It goes by way of Python's own logging, where a stream that is full or closed loses its
    line and stops nobody.
    """
    logging.raiseExceptions = False
    renderer = (
        structlog.processors.JSONRenderer()
        if form == "json"
        else structlog.dev.ConsoleRenderer(colors=sys.stderr.isatty())
    )
    stamped: list[structlog.typing.Processor] = [
        structlog.stdlib.add_log_level,
        structlog.processors.TimeStamper(fmt="iso", utc=True),
        structlog.processors.format_exc_info,
    ]
    structlog.configure(
        processors=[*stamped, structlog.stdlib.ProcessorFormatter.wrap_for_formatter],
        wrapper_class=structlog.make_filtering_bound_logger(logging.INFO),
        logger_factory=structlog.stdlib.LoggerFactory(),
    )
    handler = logging.StreamHandler(sys.stderr)
    handler.addFilter(_Repeats())
    handler.setFormatter(
        structlog.stdlib.ProcessorFormatter(processor=renderer, foreign_pre_chain=stamped)
    )
    logging.basicConfig(handlers=[handler], level=logging.WARNING, force=True)
    logging.getLogger("seacage").setLevel(logging.INFO)
