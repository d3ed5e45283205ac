"""Where a broker is and how it is spoken to."""

import ssl
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self
from urllib.parse import unquote, urlsplit

from paho.mqtt.client import Client
from paho.mqtt.enums import CallbackAPIVersion, MQTTProtocolVersion
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties

from seacage.conventions import InputError

_PORTS = {"mqtt": 1883, "mqtts": 8883}
_LARGEST_PACKET = 1 << 20  # bytes; the broker keeps longer ones to itself
KEEPALIVE_S = 30  # a connection on which nothing came for so long is dead


@dataclass(frozen=True, slots=True, kw_only=True)
class Broker:
    """A broker's place and what it asks of its clients."""

    # Where it listens
    host: str
    port: int
    tls: bool = False  # whether it speaks TLS, and shows a certificate
    # None where it asks for none; never shown
    user: str | None = None
    password: str | None = field(default=None, repr=False)
    # File of the authority that signed its certificate; the system's where None
    ca: Path | None = None

    @classmethod
    def parse(cls, url: str, *, ca: Path | None = None) -> Self:
        """Read ``mqtt://host:1883`` or ``mqtts://user:password@host:8883``.

        A user's name and password say ``%40`` for ``@`` and the like.

        Raises InputError: another scheme, no host, a port that is none, a CA file without TLS.
        """
        try:
            place = urlsplit(url)
            host, port = place.hostname, place.port
        except ValueError as error:
            raise InputError(f"{_hidden(url)} is no broker's address ({error}).") from error
        if place.scheme not in _PORTS or not host or place.path.strip("/"):
            raise InputError(
                f"{_hidden(url)} is no broker's address. Give one as mqtt://127.0.0.1:1883, or "
                "mqtts://user:password@host:8883 with TLS."
            )
        if ca is not None and place.scheme != "mqtts":
            raise InputError(
                f"{ca}: a broker at mqtt:// shows no certificate. Use mqtts://, or leave the CA "
                "file out."
            )
        return cls(
            host=host,
            port=port or _PORTS[place.scheme],
            tls=place.scheme == "mqtts",
            user=None if place.username is None else unquote(place.username),
            password=None if place.password is None else unquote(place.password),
            ca=ca,
        )

    def __str__(self) -> str:
        """Say where it is, without the password."""
        return f"{'mqtts' if self.tls else 'mqtt'}://{self.host}:{self.port}"

    def client(self, client_id: str, *, manual_ack: bool = False) -> Client:
        """Make a client of MQTT 5 that is not yet connected.

        Raises InputError: the CA file cannot be read.
        """
        made = Client(
            CallbackAPIVersion.VERSION2,
            client_id=client_id,
            protocol=MQTTProtocolVersion.MQTTv5,
            manual_ack=manual_ack,
        )
        if self.user is not None:
            made.username_pw_set(self.user, self.password)
        if self.tls:
            made.tls_set_context(self._trust())  # pyright: ignore[reportUnknownMemberType]
        return made

    def _trust(self) -> ssl.SSLContext:
        try:
            trust = ssl.create_default_context(cafile=self.ca)
        except OSError as error:  # ssl.SSLError is one
            raise InputError(
                f"{self.ca}: the CA file cannot be read ({error}). Give a PEM file."
            ) from error
        trust.sslsocket_class = _Greeting
        return trust


class _Greeting(ssl.SSLSocket):
    """Closes itself where the greeting fails, which paho leaves to chance."""

    def do_handshake(self, block: bool = False) -> None:  # noqa: FBT001, FBT002  # as its parent
        try:
            super().do_handshake(block)
        except OSError:
            self.close()
            raise


def connecting(*, receive_maximum: int, session_s: int) -> Properties:
    """What a client asks of its connection.

    ``receive_maximum``: the broker sends at most so many messages ahead of their acknowledgements.
    ``session_s``: it keeps what comes for the client so long after the connection ended [s].
    """
    properties = Properties(PacketTypes.CONNECT)
    properties.ReceiveMaximum = receive_maximum
    properties.SessionExpiryInterval = session_s
    properties.MaximumPacketSize = _LARGEST_PACKET
    return properties


def _hidden(url: str) -> str:
    """An address as it may be shown: without what stands before the @."""
    scheme, _, rest = url.rpartition("://")
    return f"{scheme}://{rest.rpartition('@')[2]}"
