import pytest

from seacage.conventions import InputError
from seacage.service._mqtt._broker import Broker, connecting


def test_an_address_says_everything():
    broker = Broker.parse("mqtts://net%40site:p%3Aw@broker.example:8884")
    assert (broker.host, broker.port, broker.tls) == ("broker.example", 8884, True)
    assert (broker.user, broker.password) == ("net@site", "p:w")


@pytest.mark.parametrize(("scheme", "port"), [("mqtt", 1883), ("mqtts", 8883)])
def test_a_port_may_be_left_out(scheme, port):
    assert Broker.parse(f"{scheme}://broker").port == port


def test_a_password_is_never_shown():
    broker = Broker.parse("mqtts://me:secret@broker")
    assert "secret" not in f"{broker} {broker!r}"
    with pytest.raises(InputError) as refused:
        Broker.parse("amqp://me:secret@broker")
    assert "secret" not in str(refused.value)


@pytest.mark.parametrize(
    "url",
    ["", "broker", "broker:1883", "http://broker", "mqtt://", "mqtt://b:port", "mqtt://b/site"],
)
def test_what_is_no_address_is_refused(url):
    with pytest.raises(InputError, match="no broker's address"):
        Broker.parse(url)


def test_a_ca_file_needs_tls(tmp_path):
    with pytest.raises(InputError, match="shows no certificate"):
        Broker.parse("mqtt://broker", ca=tmp_path / "ca.pem")


def test_a_ca_file_that_is_none_is_reported(tmp_path):
    (tmp_path / "ca.pem").write_text("nothing")
    for name in ("ca.pem", "missing.pem"):
        broker = Broker.parse("mqtts://broker", ca=tmp_path / name)
        with pytest.raises(InputError, match=name):
            broker.client("me")


def test_the_broker_is_sent_how_far_it_may_run_ahead():
    query = connecting(receive_maximum=7, session_s=60)
    assert (query.ReceiveMaximum, query.SessionExpiryInterval) == (7, 60)
