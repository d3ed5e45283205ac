import json
import stat

import httpx

from running_service import buoy, running
from seacage.service._auth._audit import Audit
from seacage.service._auth._limits import Limits


def lines(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def test_a_line_says_who_did_what_and_when_and_is_the_owners_alone(tmp_path):
    path = tmp_path / "audit.jsonl"
    Audit(path).write("POST /x", who="ada", token="0123", source="10.0.0.1", status=200)
    (line,) = lines(path)
    assert line.pop("t").endswith("+00:00")
    assert line == {
        "who": "ada",
        "token": "0123",
        "source": "10.0.0.1",
        "did": "POST /x",
        "status": 200,
    }
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_a_log_is_bounded_and_so_is_each_field(tmp_path):
    audit = Audit(tmp_path / "audit.jsonl", most=2000)
    for number in range(20):
        audit.write("POST /x" * 1000, who="ada" * 1000, source="1" * 30_000, number=number)
    files = {file.name: file.read_text() for file in tmp_path.iterdir()}
    assert sorted(files) == ["audit.before.jsonl", "audit.jsonl"]
    assert all(len(text) <= 2000 for text in files.values())
    assert lines(tmp_path / "audit.jsonl")[-1]["number"] == 19


def test_a_forged_address_is_not_written_down(tmp_path):
    path = tmp_path / "audit.jsonl"
    with running(tmp_path, audit=Audit(path)) as one:
        forged = {"X-Forwarded-For": "x" * 30_000, "Authorization": "Bearer guess"}
        httpx.get(f"{one.address}/api/v1/cages", headers=forged)
    assert [line["source"] for line in lines(path)] == ["127.0.0.1"]


def test_a_disk_that_takes_no_line_stops_nobody(tmp_path):
    (tmp_path / "audit.jsonl").mkdir()
    Audit(tmp_path / "audit.jsonl").write("POST /x", who="ada")


def test_refusals_and_signing_in_are_written_down_and_samples_and_questions_are_not(tmp_path):
    path = tmp_path / "audit.jsonl"
    with running(tmp_path, audit=Audit(path)) as one:
        one.post(buoy())
        one.reader.get("/api/v1/cages")
        one.reader.post("/api/v1/cages/ace/samples", json={"samples": [buoy()]})
        secret = one.service.tokens.mint(["read"], keep=True, name="ada")
        httpx.post(f"{one.address}/session", json={"token": secret})
        httpx.get(f"{one.address}/api/v1/cages", headers={"Authorization": "Bearer guess"})
    report = [(line["did"], line["who"], line["status"]) for line in lines(path)]
    assert report[0][0] == "POST /api/v1/cages/ace/samples"
    assert report[0][2] == 403
    assert report[1:] == [("POST /session", "ada", 201), ("GET /api/v1/cages", "", 401)]
    assert secret not in path.read_text()


def test_a_service_can_be_set_how_much_a_body_may_hold(tmp_path):
    with running(tmp_path, limits=Limits(body_bytes=1000)) as one:
        assert one.post(*[buoy(minutes=-n) for n in range(20)]).status_code == 413
