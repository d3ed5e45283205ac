"""States and alarms of cages as nodes of an OPC UA server, which can only be read."""

import asyncio
import threading
from collections.abc import Callable, Iterator, Mapping
from datetime import datetime
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import structlog

from seacage.service._live._alarm_desk import AlarmDesk
from seacage.service._live._cage import LiveCage
from seacage.service._publish._opcua_settings import OpcUaSettings
from seacage.service._schemas._alarms import alarm_state
from seacage.service._schemas._quantities import QUANTITIES, Unit
from seacage.service._schemas._state import State

NAMESPACE = "urn:seacage"
UNITS = "http://www.opcfoundation.org/UA/units/un/cefact"
_LOOK_S = 0.5  # between two looks at the cages
_POLICIES = ("Basic256Sha256", "Aes128Sha256RsaOaep", "Aes256Sha256RsaPss")
Value = float | str | None
Place = tuple[str, ...]  # of a node, below its cage
_log = structlog.get_logger(__name__)


class OpcUaServer:
    """Serves the states and alarms of cages by OPC UA.

    It runs in a thread of its own, as asyncua takes seconds to build its address space. A client
    signs in with any name and a token as its password. Where there is no number the status of the
    node is bad, and there is no value.

    ``cages``: by name. ``admits``: whether a token may read all of them.
    """

    def __init__(
        self, cages: Mapping[str, LiveCage], settings: OpcUaSettings, admits: Callable[[str], bool]
    ) -> None:
        _types()  # who lacks them learns so before the service begins
        self._cages, self._settings, self._admits = cages, settings, admits

    async def run(self) -> None:
        """Serve until cancelled."""
        stop = threading.Event()
        work = asyncio.ensure_future(asyncio.to_thread(asyncio.run, self._serve(stop)))
        try:
            await asyncio.shield(work)
        finally:
            stop.set()
            await work

    async def _serve(self, stop: threading.Event) -> None:
        server = await self._prepare()
        space = await server.register_namespace(NAMESPACE)
        folders = {name: _Folder(server, space, name) for name in self._cages}
        async with server:
            while not stop.is_set():
                for name, folder in folders.items():
                    await folder.show(self._cages[name])
                await asyncio.sleep(_LOOK_S)

    async def _prepare(self) -> Any:
        ua, readers = _types(), SimpleNamespace(get_user=self._admit)
        server = import_module("asyncua").Server(user_manager=readers)
        await server.init()
        server.set_endpoint(f"opc.tcp://{self._settings.host}:{self._settings.port}/seacage/")
        server.set_server_name("seacage")
        await server.set_application_uri(NAMESPACE)
        server.set_identity_tokens([ua.UserNameIdentityToken])
        if encrypted := self._settings.certificate is not None:
            await server.load_certificate(str(self._settings.certificate))
            await server.load_private_key(str(self._settings.key))
        policies = [f"{name}_SignAndEncrypt" for name in _POLICIES] if encrypted else ["NoSecurity"]
        server.set_security_policy([ua.SecurityPolicyType[name] for name in policies])
        return server

    def _admit(self, _: object, username: str, password: str | None, **__: object) -> object:
        """Let in, as no more than a reader, whose password is a token; asyncua calls it so."""
        rules = import_module("asyncua.crypto.permission_rules")
        if password and self._admits(password):
            return rules.User(rules.UserRole.User, username)
        _log.warning("OPC UA client refused", name=username)
        return None


class _Folder:
    """The nodes of a cage, each made when it is first known.

    ``server``, ``space``: which it is of, and the number of its namespace. ``cage``: the name.
    """

    def __init__(self, server: Any, space: int, cage: str) -> None:
        self._server, self._space, self._cage = server, space, cage
        self._objects, self._variables = dict[Place, Any](), dict[Place, Any]()
        self._shown: State | None = None

    async def show(self, cage: LiveCage) -> None:
        """Write what a cage says now, if it has not been shown yet."""
        state, before, codes = cage.current, self._shown, _types().StatusCodes
        self._shown = state
        if state is None:
            for path in self._variables if before else ():
                await self._write(path, None, codes.BadOutOfService, None)
        elif state is not before:
            bad = codes.BadNoData if state.valid else codes.BadOutOfService
            for path, unit, value in _readings(state, cage.desk):
                if path not in self._variables:
                    await self._add(path, unit, value)
                await self._write(path, value, bad, state.t)

    async def _write(self, path: Place, value: Value, bad: int, t: datetime | None) -> None:
        ua = _types()
        known = None if value is None else ua.Variant(value, _kind(value))
        status = ua.StatusCode(bad if value is None else ua.StatusCodes.Good)
        written = ua.DataValue(known, status, SourceTimestamp=t)
        await self._server.write_attribute_value(self._variables[path].nodeid, written)

    async def _add(self, path: Place, unit: Unit | None, value: Value) -> None:
        """Make the variable of a path, and the objects above it."""
        ua, above, kind = _types(), self._server.nodes.objects, _kind(value).value
        for place in (path[:depth] for depth in range(len(path))):
            if place not in self._objects:
                self._objects[place] = await above.add_object(*self._name(place))
            above = self._objects[place]
        name = self._name(path)
        made = await above.add_variable(*name, None, ua.VariantType.Null, ua.NodeId(kind))
        self._variables[path] = made
        if unit:
            code, text = int.from_bytes(unit.unece.encode()), ua.LocalizedText(unit.symbol)
            about = ua.EUInformation(NamespaceUri=UNITS, UnitId=code, DisplayName=text)
            await made.add_property(0, "EngineeringUnits", about)

    def _name(self, path: Place) -> tuple[Any, Any]:
        ua, words = _types(), (self._cage, *path)
        return ua.NodeId("/".join(words), self._space), ua.QualifiedName(words[-1], self._space)


def _readings(state: State, desk: AlarmDesk) -> Iterator[tuple[Place, Unit | None, Value]]:
    for one in QUANTITIES:
        for name, value in one.read(state):
            yield (one.part, *filter(None, (name, one.name))), one.unit, value
    for text in ("origin", "twin", "reason"):
        yield ("cage", text), None, getattr(state, text)
    for alarm in desk.alarms.values():
        now = alarm_state(alarm, desk.policy)
        for key in ("active", "acknowledged", "severity", "title", "message"):
            yield ("alarms", alarm.name, key), None, getattr(now, key)


def _kind(value: Value) -> Any:
    kinds: dict[type, str] = {bool: "Boolean", int: "UInt16", str: "String"}
    return _types().VariantType[kinds.get(type(value), "Double")]


def _types() -> Any:
    """The types of OPC UA; to a checker their numbers are none of Python's."""
    return import_module("asyncua.ua")
