"""States and alarms by OPC UA, as asyncua's own client reads them."""

import asyncio
import re
import shlex
import shutil
import socket
import subprocess
import threading
from contextlib import asynccontextmanager, contextmanager
from datetime import UTC, datetime
from pathlib import Path

import pytest

from running_service import Running, buoy, depth, eventually, running
from seacage.service._live import _cage
from seacage.service._publish._opcua_server import NAMESPACE, UNITS, OpcUaServer
from seacage.service._publish._opcua_settings import OpcUaSettings

asyncua = pytest.importorskip("asyncua")
ua = asyncua.ua


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as free:
        return free.getsockname()[1]


@contextmanager
def serving(live: Running, **how):
    """A server of a service's cages, until the block ends; its address."""
    port = free_port()
    server = OpcUaServer(
        live.service.cages,
        OpcUaSettings(port=port, **how),
        lambda token: live.service.tokens.grant(token) is not None,
    )
    loop = asyncio.new_event_loop()
    work = []

    def work_until_cancelled():
        work.append(loop.create_task(server.run()))
        with pytest.raises(asyncio.CancelledError):
            loop.run_until_complete(work[0])

    thread = threading.Thread(target=work_until_cancelled)
    thread.start()
    try:
        eventually(lambda: answers(port), bool, seconds=60)
        yield f"opc.tcp://127.0.0.1:{port}/seacage/"
    finally:
        loop.call_soon_threadsafe(work[0].cancel)
        thread.join(20)
        assert not thread.is_alive(), "the server has stopped"
        loop.close()
        assert not answers(port)


def answers(port):
    try:
        socket.create_connection(("127.0.0.1", port), timeout=1).close()
    except OSError:
        return False
    return True


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    with running(tmp_path_factory.mktemp("opcua")) as live, serving(live) as address:
        yield live, address


@pytest.fixture
def fresh(tmp_path):
    """A service to which no test has sent anything."""
    with running(tmp_path) as live, serving(live) as address:
        yield live, address


@asynccontextmanager
async def client_of(live, address, password=None):
    client = asyncua.Client(address, timeout=20)
    client.set_user("scada")
    client.set_password(password or live.service.tokens.mint(["read"], keep=False))
    async with client:
        yield client, await client.get_namespace_index(NAMESPACE)


def ask(service, work, **how):
    """What a coroutine of a client and the namespace's number returns."""

    async def asking():
        async with client_of(*service, **how) as (client, space):
            return await work(client, space)

    return asyncio.run(asyncio.wait_for(asking(), 60))


def read(service, *paths):
    """Value and status of each node, once the server shows the state of now."""

    async def work(client, space):
        nodes = [client.get_node(ua.NodeId(path, space)) for path in paths]
        return [await node.read_data_value(raise_on_bad_status=False) for node in nodes]

    return ask(service, work)


def shown(service, path, accept):
    return eventually(lambda: read(service, path)[0], accept, seconds=20)


def good(found):
    return found.StatusCode.is_good()


def test_without_valid_input_a_number_has_a_bad_status_and_no_value(fresh):
    path, out = "ace/bridle/bridle-1/tension_kn", ua.StatusCodes.BadOutOfService
    found = shown(fresh, path, lambda value: value.StatusCode.value == out)
    assert found.Value.Value is None
    valid, reason = read(fresh, "ace/cage/valid", "ace/cage/reason")
    assert valid.Value.Value is False
    assert reason.Value.Value


def test_values_are_those_of_the_interface_with_their_times_and_units(fresh):
    live, _ = fresh
    live.post(buoy(), depth())
    state = eventually(live.state, lambda state: state["valid"])
    path = "ace/bridle/bridle-1/tension_kn"
    shown(fresh, path, good)
    for bridle in state["bridles"]:
        names = ("tension_kn", "tension_lower_kn", "tension_upper_kn", "utilisation")
        found = read(fresh, *(f"ace/bridle/{bridle['name']}/{name}" for name in names))
        tension = bridle["tension_kn"]
        values = [one.Value.Value for one in found]
        assert values == [*(tension[k] for k in ("mean", "lower", "upper")), bridle["utilisation"]]
        assert found[0].SourceTimestamp.replace(tzinfo=UTC) == datetime.fromisoformat(state["t"])
    speed, volume, measured, unknown, origin = read(
        fresh,
        "ace/water/current_speed_m_s",
        "ace/net/volume",
        "ace/depth/depth-2/measured_m",
        "ace/water/hs_m",
        "ace/cage/origin",
    )
    assert speed.Value.Value == 0.5
    assert volume.Value.Value == state["volume_fraction"]
    assert measured.Value.Value == 14.0
    assert unknown.StatusCode.value == ua.StatusCodes.BadNoData
    assert origin.Value.Value == "virtual field"

    async def unit(client, space):
        node = client.get_node(ua.NodeId(path, space))
        return await (await node.get_child("0:EngineeringUnits")).read_value()

    about = ask(fresh, unit)
    # Kilonewton is B47 in UNECE's recommendation 20, as OPC UA Part 8 makes a number of it
    assert (about.NamespaceUri, about.UnitId) == (UNITS, (0x42 << 16) + (0x34 << 8) + 0x37)
    assert about.DisplayName.Text == "kN"


def test_the_tree_is_browsed_by_cage_part_and_name(service):
    async def work(client, space):
        found = [f"{space}:{name}" for name in ("ace", "bridle", "bridle-2", "tension_kn")]
        node = await client.nodes.objects.get_child(found)
        return node.nodeid.Identifier

    assert ask(service, work) == "ace/bridle/bridle-2/tension_kn"


def test_alarms_are_nodes(service):
    live, _ = service
    alarms = eventually(
        lambda: live.reader.get("/api/v1/cages/ace/alarms").json()["alarms"], bool, seconds=20
    )
    names = ("active", "acknowledged", "severity", "message")
    for alarm in alarms[:5]:
        shown(service, f"ace/alarms/{alarm['id']}/active", good)
        found = read(service, *(f"ace/alarms/{alarm['id']}/{name}" for name in names))
        assert [one.Value.Value for one in found] == [alarm[name] for name in names]


def test_nothing_can_be_written_or_changed(service):
    async def work(client, space):
        node = client.get_node(ua.NodeId("ace/bridle/bridle-1/tension_kn", space))
        before = (await node.read_data_value(raise_on_bad_status=False)).Value
        with pytest.raises(ua.UaStatusCodeError):
            await node.write_value(1.0, ua.VariantType.Double)
        with pytest.raises(ua.UaStatusCodeError):
            await node.set_writable()
        with pytest.raises((ua.UaStatusCodeError, ConnectionError)):
            await client.nodes.objects.add_object(space, "mine")
        return before

    before = ask(service, work)
    assert read(service, "ace/bridle/bridle-1/tension_kn")[0].Value == before


@pytest.mark.parametrize("password", ["guess", "x" * 43])
def test_who_has_no_token_is_refused(service, password):
    with pytest.raises(ua.UaStatusCodeError):
        ask(service, lambda *_: None, password=password)


def test_nobody_is_anonymous(service):
    async def work():
        async with asyncua.Client(service[1], timeout=20):
            pass

    with pytest.raises(ua.UaStatusCodeError):
        asyncio.run(asyncio.wait_for(work(), 60))


def test_a_client_is_told_of_each_change(service):
    live, _ = service

    class Listener:
        def __init__(self):
            self.values = []

        def datachange_notification(self, _node, value, _data):
            self.values.append(value)

    async def work(client, space):
        listener = Listener()
        subscription = await client.create_subscription(100, listener)
        node = client.get_node(ua.NodeId("ace/water/current_speed_m_s", space))
        await subscription.subscribe_data_change(node)
        live.clock.at = live.clock.at.replace(minute=10)
        await asyncio.to_thread(live.post, buoy(10, speed=0.7))
        while 0.7 not in listener.values:
            await asyncio.sleep(0.1)
        await subscription.delete()

    ask(service, work)


def test_a_cage_that_is_no_longer_stepped_has_bad_status(service, monkeypatch):
    path = "ace/bridle/bridle-1/tension_kn"
    service[0].post(buoy(), depth())
    shown(service, path, good)
    monkeypatch.setattr(_cage, "STALLED_S", -60.0)
    shown(service, path, lambda found: not good(found))
    tension, valid = read(service, path, "ace/cage/valid")
    for found in (tension, valid):
        assert found.StatusCode.value == ua.StatusCodes.BadOutOfService
        assert found.Value.Value is None
    monkeypatch.undo()
    shown(service, path, good)


@pytest.fixture(scope="module")
def encrypted(tmp_path_factory):
    """A server with the certificate that docs/integrate.md has made."""
    if shutil.which("openssl") is None:
        pytest.skip("needs openssl, to make certificates")
    folder = tmp_path_factory.mktemp("encrypted")
    page = Path(__file__).parents[4].joinpath("docs/integrate.md").read_text()
    text = re.search(r"\$ (openssl req .+?-out \S+)", page, re.DOTALL)[1]
    command = shlex.split(text.replace("\\\n", " "))
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    with running(folder) as live:
        files = {"certificate": folder / "opcua-certificate.pem", "key": folder / "opcua-key.pem"}
        with serving(live, **files) as address:
            yield live, address, files


@pytest.mark.slow
def test_with_a_certificate_every_client_signs_and_encrypts(encrypted):
    live, address, files = encrypted

    async def work():
        client = asyncua.Client(address, timeout=20)
        client.set_user("scada")
        client.set_password(live.service.tokens.mint(["read"], keep=False))
        own = {one: str(path) for one, path in files.items()}
        policy = asyncua.crypto.security_policies.SecurityPolicyBasic256Sha256
        await client.set_security(policy, own["certificate"], own["key"])
        async with client:
            space = await client.get_namespace_index(NAMESPACE)
            node = client.get_node(ua.NodeId("ace/cage/origin", space))
            return await node.read_value()

    assert asyncio.run(asyncio.wait_for(work(), 60)) == "virtual field"
    with pytest.raises((ua.UaError, ConnectionError)):
        ask((live, address), lambda *_: None)
