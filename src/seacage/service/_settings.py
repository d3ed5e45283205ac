"""What a service is told: by its command line, else its environment, a file, or by default."""

from collections.abc import Mapping
from ipaddress import ip_network
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, Field, ValidationError, model_validator
from pydantic_settings import BaseSettings, InitSettingsSource, SettingsConfigDict

from seacage.conventions import InputError, parse_toml, read_text
from seacage.service._auth._limits import Limits
from seacage.service._mqtt._topics import Name
from seacage.service._publish._opcua_settings import OpcUaSettings
from seacage.service._publish._post import Webhook
from seacage.service._schemas._base import AbstractSection

_LOOPBACK = ("127.0.0.1", "::1", "localhost")
# An address, or a network as ``10.0.0.0/8``
Network = Annotated[str, AfterValidator(lambda text: str(ip_network(text)))]


class StoreSection(AbstractSection):
    """The section ``[store]``."""

    # ``postgresql://user@host/name``, or a path for SQLite; in the data folder if left out
    url: str | None = None
    # Samples older than this are deleted [d]; all are kept if left out
    keep_days: float | None = Field(default=None, gt=0.0, le=36_525.0)
    # Folder that samples are written to as Parquet before they are deleted
    archive: Path | None = None

    @model_validator(mode="after")
    def _archive_needs_an_age(self) -> Self:
        if self.archive is not None and self.keep_days is None:
            raise ValueError("archive is used when samples leave the store; give keep_days too")
        return self


class MqttSection(AbstractSection):
    """The section ``[mqtt]``."""

    # ``mqtt://host:1883`` or ``mqtts://user:password@host:8883``; a password is better given in the
    # environment, as ``SEACAGE_MQTT__URL``
    url: str
    # Certificate of the authority that the broker's is signed by; the system's if left out
    ca: Path | None = None
    # Of this process; two processes never share one. ``seacage-`` and the site if left out
    client_id: Name | None = None
    # Name of a shared subscription; a process that stands by for another has the same
    group: Name | None = None
    # How often a cage's state is published [s]
    state_every_s: float = Field(default=10.0, ge=1.0, le=3600.0)
    # Where Home Assistant looks for devices, ``homeassistant``; none are announced if left out
    home_assistant: Name | None = None


class TailSection(AbstractSection):
    """One ``[[cages.tail]]``: a table that a logger appends to."""

    path: Path  # of the file; it may come later
    stream: Name = "buoy-1"  # what its rows are readings of


class CageSection(AbstractSection):
    """One ``[[cages]]``."""

    twin: Path  # folder of its trained twin
    # Under which it is served; the twin's own name for its cage if left out
    name: Name | None = None
    tail: tuple[TailSection, ...] = ()  # tables that are read as they grow
    alarms: dict[str, Any] = Field(default_factory=dict)  # as ``[alarms]``, for this cage alone


class Settings(BaseSettings):
    """Settings of ``seacage serve``; each is also an environment variable, ``SEACAGE_PORT``.

    A variable of a section has two underscores: ``SEACAGE_STORE__URL``.
    """

    model_config = SettingsConfigDict(
        env_prefix="SEACAGE_", env_nested_delimiter="__", extra="ignore", frozen=True
    )

    site: Name = "site"  # where the cages lie, as topics and scopes name it
    # File of the key that twins are signed with (``seacage train --sign``): with it no other twin
    # is taken, and where one is refused, the one that was served last goes on
    twin_key: Path | None = None
    data: Path = Path("var")  # the folder that keeps everything the service writes
    # Where it listens
    host: str = "127.0.0.1"
    port: int = Field(default=8000, ge=0, le=65535)
    # PEM files: with them it speaks HTTPS
    certificate: Path | None = None
    key: Path | None = None
    insecure_http: bool = False  # listen without TLS where others can hear
    # Addresses or networks of proxies that are believed about whose request they bring
    trusted_proxies: tuple[Network, ...] = ()
    # Longest pause between two looks at the clock [s of the wall]
    tick_s: float = Field(default=2.0, gt=0.0, le=60.0)
    # The machine's, or one that stands where the newest sample stands and runs so fast between
    # samples: for a record that is published as if it were live
    clock: Literal["wall", "samples"] = "wall"
    speed: float = Field(default=1.0, ge=0.1, le=10_000.0)
    # Of a farm that several processes serve: which one this is, from 0, and how many there are. It
    # serves the cages that fall to it.
    worker: int = Field(default=0, ge=0)
    workers: int = Field(default=1, ge=1, le=10_000)
    log: Literal["lines", "json"] = "lines"  # lines for people or JSON for machines
    store: StoreSection = StoreSection()
    mqtt: MqttSection | None = None
    opcua: OpcUaSettings | None = None
    cages: tuple[CageSection, ...] = ()
    # Limits by kind or name, as ``seacage.twin.AlarmPolicy.from_dict`` takes them
    alarms: dict[str, Any] = Field(default_factory=dict)
    webhooks: tuple[Webhook, ...] = ()
    limits: Limits = Limits()
    # Share of the still-water volume below which a cage is not called well [-]
    least_volume: float = Field(default=0.8, ge=0.0, le=1.0)

    @model_validator(mode="after")
    def _settings_agree(self) -> Self:
        if any(
            (one.certificate is None) != (one.key is None) for one in (self, self.opcua or self)
        ):
            raise ValueError("TLS takes both a certificate and its key")
        names = [cage.name for cage in self.cages]
        if len(names) > 1 and (None in names or len(set(names)) < len(names)):
            raise ValueError("several cages take a name each, and no two the same")
        if self.worker >= self.workers:
            raise ValueError(
                f"worker = {self.worker} of workers = {self.workers}; they count from 0"
            )
        if self.workers > 1 and None in names:
            raise ValueError("cages that workers share take a name each")
        return self

    def check_host(self) -> None:
        """Refuse to speak plain HTTP or OPC UA where others can hear.

        Raises InputError: an address beyond loopback without a certificate or ``--insecure-http``.
        """
        opcua = self.opcua
        if opcua and opcua.certificate is None and opcua.host not in _LOOPBACK:
            raise InputError(
                f"serve: opcua.host = {opcua.host} is reachable from outside, and tokens would be "
                "sent in plain text. Give opcua.certificate and opcua.key, or listen on 127.0.0.1."
            )
        safe = self.host in _LOOPBACK or self.certificate is not None
        if not safe and not self.insecure_http:
            raise InputError(
                f"serve: {self.host} is reachable from outside, and this service would speak "
                "plain HTTP. Give --certificate and --key, listen on 127.0.0.1 behind a TLS "
                "proxy, or pass --insecure-http."
            )


def read_settings(file: Path | None = None, **given: object) -> Settings:
    """Put together what was given, the environment, a file and the defaults.

    ``file``: TOML; paths in it are taken from where the service is started. ``given``: by the
    command line; None is not given.

    Raises InputError: the file cannot be read, or a setting is unknown or does not do.
    """
    sources = _above({} if file is None else _read(file))
    try:
        return sources.model_validate({key: v for key, v in given.items() if v is not None})
    except ValidationError as error:
        first = error.errors()[0]
        name = ".".join(map(str, first["loc"])) or "the settings"
        value = f" = {first['input']!r}" if _may_be_shown(name, first["input"]) else ""
        where = f"{file}, the option" if file else "the option"
        raise InputError(
            f"serve: {name}{value} does not do: {first['msg'].removeprefix('Value error, ')}. "
            f"Mend {where} or its variable SEACAGE_…"
        ) from error


def _above(table: Mapping[str, Any]) -> type[Settings]:
    """Settings that take what neither the command line nor the environment says from a table."""

    class FromFile(Settings):
        @classmethod
        def settings_customise_sources(
            cls, settings_cls: Any, init_settings: Any, env_settings: Any, *_: Any, **__: Any
        ) -> tuple[Any, ...]:
            file = InitSettingsSource(settings_cls, init_kwargs=dict(table))
            return init_settings, env_settings, file

    return FromFile


def _may_be_shown(name: str, value: object) -> bool:
    """Whether a value holds no secret: neither a key, an address with a password, nor a table."""
    secret = any(part in name for part in ("secret", "url"))
    return isinstance(value, str | int | float) and not secret


def _read(file: Path) -> dict[str, Any]:
    table = parse_toml(read_text(file), str(file), finite=True)
    unknown = sorted(table.keys() - Settings.model_fields.keys())
    if unknown:
        raise InputError(
            f"{file}: the setting {unknown[0]!r} is unknown. There are: "
            f"{', '.join(Settings.model_fields)}."
        )
    return table


def without_password(address: str) -> str:
    """Leave out of an address what stands before the ``@``."""
    scheme, found, rest = address.rpartition("://")
    return f"{scheme}{found}{rest.rpartition('@')[2]}"
