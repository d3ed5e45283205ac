import json
from datetime import UTC, datetime

from seacage.service._quarantine import Quarantine

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


def test_a_refused_message_is_kept_with_its_reason(tmp_path):
    path = tmp_path / "quarantine.jsonl"
    Quarantine(path).put("a/topic", b"\xff{}", "It is no JSON.", now=NOON)
    line = json.loads(path.read_text())
    assert line["from"] == "a/topic"
    assert line["reason"] == "It is no JSON."
    assert line["t"] == NOON.isoformat()
    assert line["payload"] == "\ufffd{}"


def test_the_file_has_a_bound_also_after_a_restart(tmp_path):
    path = tmp_path / "quarantine.jsonl"
    for _ in range(3):
        quarantine = Quarantine(path, most=10_000)
        for number in range(100):
            quarantine.put("topic", b"x" * 5000, f"reason {number}", now=NOON)
    sizes = [file.stat().st_size for file in tmp_path.iterdir()]
    assert len(sizes) == 2
    assert max(sizes) <= 10_000
    assert json.loads(path.read_text().splitlines()[-1])["reason"] == "reason 99"


def test_where_nothing_can_be_written_it_still_counts(tmp_path):
    (tmp_path / "file").touch()
    quarantine = Quarantine(tmp_path / "file" / "quarantine.jsonl")
    assert not quarantine.put("topic", b"", "reason", now=NOON)
    assert quarantine.count == 1


def test_a_line_that_a_full_disk_cut_off_spoils_no_other(tmp_path):
    path = tmp_path / "quarantine.jsonl"
    path.write_text('{"t": "2020-')
    assert Quarantine(path).put("a/topic", b"{}", "reason", now=NOON)
    assert json.loads(path.read_text().splitlines()[-1])["reason"] == "reason"
