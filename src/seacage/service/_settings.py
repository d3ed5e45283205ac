"""What a service is told: by its command line, else the environment, else by default."""

from pathlib import Path
from typing import Literal

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict

from seacage.conventions import InputError

_LOOPBACK = ("127.0.0.1", "::1", "localhost")


class Settings(BaseSettings):
    """Settings of ``seacage serve``; each is also an environment variable, ``SEACAGE_PORT``.

    Parameters
    ----------
    data
        The folder that keeps everything the service writes.
    host, port
        Where it listens.
    insecure_http
        Listen without TLS where others can hear.
    tick_s
        Longest pause between two looks at the clock [s of the wall].
    log
        Lines for people or JSON for machines.
    """

    model_config = SettingsConfigDict(env_prefix="SEACAGE_", extra="ignore", frozen=True)

    data: Path = Path("var")
    host: str = "127.0.0.1"
    port: int = Field(default=8000, ge=0, le=65535)
    insecure_http: bool = False
    tick_s: float = Field(default=2.0, gt=0.0, le=60.0)
    log: Literal["lines", "json"] = "lines"

    def check_host(self) -> None:
        """Refuse to speak plain HTTP where others can hear.

        Raises
        ------
        InputError
            An address beyond loopback without ``--insecure-http``.
        """
        if self.host not in _LOOPBACK and not self.insecure_http:
            raise InputError(
                f"serve: {self.host} is reachable from outside, and this service speaks plain "
                "HTTP. Listen on 127.0.0.1 behind a TLS proxy, or pass --insecure-http."
            )
