"""Where OPC UA is served, apart from its server, so that settings are read without the twin."""

from pathlib import Path

from pydantic import Field

from seacage.service._schemas._base import AbstractSection


class OpcUaSettings(AbstractSection):
    """The section ``[opcua]``."""

    # Where it listens
    host: str = "127.0.0.1"
    port: int = Field(default=4840, ge=1, le=65535)
    # PEM files of an RSA key: with them every client has to sign and to encrypt
    certificate: Path | None = None
    key: Path | None = None
