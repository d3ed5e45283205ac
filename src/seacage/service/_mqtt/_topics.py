"""The topics of a site: who says what where."""

import re
from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from seacage.conventions import InputError

_LEVEL = r"[A-Za-z0-9][A-Za-z0-9_.\-]{0,63}"
_OBSERVED = re.compile(r"seacage/v1/([^/+#]+)/([^/+#]+)/([^/+#]+)/(obs|ack)")
# Of a site, a cage, a worker: it becomes part of addresses and topics
Name = Annotated[str, Field(pattern=f"^{_LEVEL}$")]


class Address(NamedTuple):
    """Whose samples or acknowledgements a topic carries."""

    cage: str
    stream: str


@dataclass(frozen=True, slots=True)
class Topics:
    """Topics below ``seacage/v1/{site}``.

    Raises InputError: another name, which could not be a level of a topic.
    """

    site: str  # its name: up to 64 letters, digits and ``_ . -``

    def __post_init__(self) -> None:
        if re.fullmatch(_LEVEL, self.site) is None:
            raise InputError(
                f"{self.site!r} is no site's name: up to 64 letters, digits, '_', '.' or '-', "
                "the first a letter or a digit."
            )

    def samples(self, cage: str, stream: str = "+") -> str:
        """Where samples come in; those of all streams where none is named."""
        return f"seacage/v1/{self.site}/{cage}/{stream}/obs"

    def acknowledgements(self, cage: str, stream: str = "+") -> str:
        """Where the service says which samples it has."""
        return f"seacage/v1/{self.site}/{cage}/{stream}/ack"

    def outgoing(self, cage: str, what: Literal["state", "alarms"]) -> str:
        """Where a cage's state or its alarms go out."""
        return f"seacage/v1/{self.site}/{cage}/{what}"

    def status(self, client: str) -> str:
        """Where a service says that it is there, and the broker that it is not."""
        return f"seacage/v1/{self.site}/{client}/status"

    def address(self, topic: str) -> Address | None:
        """Read whose samples or acknowledgements a topic carries; None for any other topic."""
        found = _OBSERVED.fullmatch(topic)
        return None if found is None or found[1] != self.site else Address(found[2], found[3])


def share(topic: str, group: str | None) -> str:
    """The filter that shares a topic among the clients of a group; without one, the topic."""
    return topic if group is None else f"$share/{group}/{topic}"
