import json

import pytest
from typer.testing import CliRunner

from seacage.records import read_record
from seacage.service import _assembly
from seacage.service._cli import _serve
from seacage.service._cli._app import app
from seacage.service._live._replay import replay_of
from seacage.testing import stand_in_twin


class Stopped:
    """A server that has nothing to do."""

    def run(self, *, sockets):
        assert sockets


@pytest.mark.parametrize(("options", "scopes"), [(["--demo"], ("read", "ack")), ([], ("read",))])
def test_the_link_of_a_demonstration_may_acknowledge_and_that_of_a_cage_may_not(
    tmp_path, monkeypatch, options, scopes
):
    services, times = [], [f"2020-01-01T00:{minute:02}:00Z" for minute in range(10)]
    table = tmp_path / "buoy.csv"
    rows = [f"{t},0.5,90" for t in times]
    table.write_text("\n".join(["time,current_speed_m_s,current_to_deg", *rows, ""]))
    replay = replay_of(read_record(table)) if options else None
    monkeypatch.setattr(_serve, "_prepare", lambda *_, **__: ({"ace": stand_in_twin()}, replay))
    monkeypatch.setattr(
        _assembly, "server", lambda service, _: services.append(service) or Stopped()
    )
    words = ["serve", "--data", str(tmp_path), "--port", "0", "--json", *options]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    service, outcome = services[0], json.loads(done.stdout)
    service.store.close()
    assert service.tokens.grant(outcome["token"]).scopes == scopes
