import asyncio
import csv
import io
import tempfile

import pytest
import xarray

from running_service import Running, at, buoy, depth, eventually
from seacage.service._auth._limits import Limits

PATIENCE_S = 60.0  # the first NetCDF loads xarray


def table(answer):
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"].startswith("text/csv")
    return list(csv.DictReader(io.StringIO(answer.text)))


@pytest.fixture
def fed(live: Running):
    """A service that has heard a buoy and a sensor."""
    live.post(buoy(-30), buoy(-20, speed=-1.0), buoy(-10), depth(-15), depth(-10, stream="depth-1"))
    return live


def test_samples_come_as_a_table_with_a_row_per_value(fed: Running):
    rows = table(fed.reader.get("/api/v1/cages/ace/samples.csv"))
    assert len(rows) == 3 * 2 + 2
    assert rows[0] == {
        "t": "2020-02-01T11:30:00Z",
        "stream": "buoy-1",
        "seq": "",
        "quantity": "current_speed_m_s",
        "value": "0.5",
        "flag": "1",
    }
    bad = [row for row in rows if row["value"] == "-1.0"]
    assert [row["flag"] for row in bad] == ["4"], "a raw value is kept, with its flag"
    assert [row["t"] for row in rows] == sorted(row["t"] for row in rows)


@pytest.mark.parametrize("size", [1, 2, 3, 5])
def test_a_table_of_many_pages_holds_each_sample_once(fed: Running, monkeypatch, size):
    monkeypatch.setattr("seacage.service._http._download_routes.PAGE", size)
    fed.post(depth(-9), depth(-8), depth(-8, stream="depth-3"))
    rows = table(fed.reader.get("/api/v1/cages/ace/samples.csv?stream=depth-2"))
    assert [row["t"][14:16] for row in rows] == ["45", "51", "52"]


def test_a_span_and_a_stream_choose_the_rows(fed: Running):
    body = {"stream": "buoy-1", "from": at(-20), "to": at(-10)}
    rows = table(fed.reader.get("/api/v1/cages/ace/samples.csv", params=body))
    assert {row["t"] for row in rows} == {"2020-02-01T11:40:00Z"}


def test_the_answers_come_as_a_table_with_units_in_its_head(fed: Running):
    answer = fed.reader.get("/api/v1/cages/ace/history.csv")
    rows = table(answer)
    assert answer.headers["content-disposition"] == 'attachment; filename="ace-history.csv"'
    assert [row["valid"] for row in rows] == ["True", "False", "True"]
    state = fed.state(at=at(-10))
    mean = state["bridles"][0]["tension_kn"]["mean"]
    assert float(rows[2]["bridle-1_kn"]) == pytest.approx(mean, abs=1e-3)


def test_the_answers_come_as_netcdf_with_the_whole_shape(fed: Running, tmp_path):
    answer = fed.reader.get("/api/v1/cages/ace/history.nc", timeout=PATIENCE_S)
    assert answer.headers["content-type"] == "application/x-netcdf"
    path = tmp_path / "history.nc"
    path.write_bytes(answer.content)
    with xarray.open_dataset(path, engine="h5netcdf") as dataset:
        assert dataset.attrs["Conventions"].startswith("CF-1.11")
        assert dataset["node_position"].shape == (3, fed.cage.twin.cage.node_count, 3)
        assert dataset["valid"].values.tolist() == [1, 0, 1]


def blocks_seen(fed: Running, monkeypatch, size):
    """Answer in blocks of so many rows; how many rows the twin is asked for at a time."""
    monkeypatch.setattr("seacage.service._export.BLOCK", size)
    seen, twin = [], type(fed.cage.twin)
    answer = twin.predict_record
    monkeypatch.setattr(
        twin,
        "predict_record",
        lambda self, rows, **o: seen.append(len(rows)) or answer(self, rows, **o),
    )
    return seen


@pytest.mark.slow
def test_a_long_netcdf_is_written_in_blocks_and_is_the_same_file(
    fed: Running, monkeypatch, tmp_path
):
    path = "/api/v1/cages/ace/history.nc"
    fed.post(buoy(-5) | {"t": "2020-02-01T11:55:00.000250Z"}, buoy(-4, speed=None))
    for name, size in (("whole.nc", 512), ("blocks.nc", 2)):
        with monkeypatch.context() as patch:
            seen = blocks_seen(fed, patch, size)
            content = fed.reader.get(path, timeout=PATIENCE_S).content
        (tmp_path / name).write_bytes(content)
    assert seen == [2, 2, 1]
    with (
        xarray.open_dataset(tmp_path / "whole.nc", engine="h5netcdf") as whole,
        xarray.open_dataset(tmp_path / "blocks.nc", engine="h5netcdf") as blocks,
    ):
        xarray.testing.assert_allclose(whole, blocks)
        assert (whole.attrs, list(whole.time.values)) == (blocks.attrs, list(blocks.time.values))
        assert list(whole.reason.values) == list(blocks.reason.values)


@pytest.mark.parametrize("name", ["history", "history.csv"])
def test_a_long_answer_is_made_in_blocks_and_is_the_same(fed: Running, monkeypatch, name):
    path = f"/api/v1/cages/ace/{name}"
    whole = fed.reader.get(path).text
    seen = blocks_seen(fed, monkeypatch, 2)
    assert fed.reader.get(path).text == whole
    assert seen == [2, 1]


def test_a_file_is_gone_from_the_disk_before_it_is_sent(fed: Running, monkeypatch, tmp_path):
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    path = "/api/v1/cages/ace/history.nc"
    with fed.reader.stream("GET", path, timeout=PATIENCE_S) as answer:
        assert answer.status_code == 200
        assert list(folder.iterdir()) == []
        assert len(answer.read()) == int(answer.headers["content-length"])


@pytest.mark.parametrize("name", ["history", "history.csv", "history.nc", "samples", "samples.csv"])
def test_beyond_its_budget_a_long_answer_has_to_wait(fed: Running, name):
    reads, path = fed.service.gate.reads, f"/api/v1/cages/ace/{name}?limit=10000"
    limits = Limits()
    for others in range(limits.read_rows // limits.read_rows_per_token):
        asyncio.run(reads.take(f"other-{others}", limits.read_rows_per_token))
    answer = fed.reader.get(path)
    assert answer.status_code == 429
    assert int(answer.headers["retry-after"]) >= 1
    assert fed.reader.get("/api/v1/cages/ace/state").status_code == 200
    reads.give_back("other-0", limits.read_rows_per_token)
    for _ in range(3):  # each has given its rows back
        assert fed.reader.get(path, timeout=PATIENCE_S).status_code == 200


def test_who_leaves_in_the_middle_gives_the_budget_back(fed: Running, monkeypatch):
    path, many = "/api/v1/cages/ace/samples?limit=10000", 5000
    sample = fed.cage.store.samples("ace", limit=1)
    monkeypatch.setattr(fed.cage.store, "samples", lambda *_, **__: sample * 20 * many)
    plain = {"Accept-Encoding": "identity"}  # packed, it would fit into what the system holds
    with fed.reader.stream("GET", path, headers=plain) as answer:
        assert answer.status_code == 200
        assert fed.reader.get(path).status_code == 429
    monkeypatch.undo()
    again = eventually(lambda: fed.reader.get(path).status_code, lambda code: code == 200)
    assert again == 200


@pytest.mark.parametrize("name", ["samples.csv", "history.csv", "history.nc"])
def test_where_nothing_was_received_a_file_is_empty_and_whole(idle: Running, name):
    assert idle.reader.get(f"/api/v1/cages/ace/{name}", timeout=PATIENCE_S).status_code == 200


def test_without_netcdf_a_service_says_what_to_ask_instead(idle: Running, monkeypatch):
    monkeypatch.setattr("seacage.service._http._download_routes.find_spec", lambda _: None)
    answer = idle.reader.get("/api/v1/cages/ace/history.nc")
    assert answer.status_code == 501
    assert "CSV" in answer.json()["detail"]


def test_the_latest_of_all_streams_comes_in_one_call(fed: Running):
    latest = fed.reader.get("/api/v1/cages/ace/latest").json()["samples"]
    assert [(one["stream"], one["t"][11:16]) for one in latest] == [
        ("buoy-1", "11:50"),
        ("depth-1", "11:50"),
        ("depth-2", "11:45"),
    ]
    past = fed.reader.get("/api/v1/cages/ace/latest", params={"at": at(-25)}).json()["samples"]
    assert [(one["stream"], one["t"][11:16]) for one in past] == [("buoy-1", "11:30")]


def test_aggregates_leave_out_what_failed_its_checks(fed: Running):
    body = {"stream": "buoy-1", "key": "current_speed_m_s", "width_s": 600}
    answer = fed.reader.get("/api/v1/cages/ace/aggregates", params=body).json()
    assert answer["aggregates"] == [
        {"t": f"2020-02-01T11:{minute}:00Z", "count": 1, "mean": 0.5, "least": 0.5, "most": 0.5}
        for minute in (30, 50)
    ]


@pytest.mark.parametrize(
    "odd", [{"width_s": 61}, {"key": "current_to_deg"}, {"key": "mood"}, {"limit": 10_001}]
)
def test_aggregates_that_are_not_kept_are_refused(idle: Running, odd):
    body = {"stream": "buoy-1", "key": "current_speed_m_s"} | odd
    assert idle.reader.get("/api/v1/cages/ace/aggregates", params=body).status_code == 422


@pytest.mark.parametrize("at", ["0001-01-01T00:00:00Z", "9999-12-31T23:59:59.999999Z"])
@pytest.mark.parametrize("what", ["state", "shape", "frame", "latest"])
def test_the_ends_of_all_time_are_answered_without_a_number(idle: Running, what, at):
    assert idle.reader.get(f"/api/v1/cages/ace/{what}", params={"at": at}).is_success


def test_a_sample_from_before_all_clocks_is_rejected_with_a_reason(idle: Running):
    sample = depth() | {"t": "1950-01-01T00:00:00Z"}
    (rejection,) = idle.post(sample).json()["rejected"]
    assert "before 1970" in rejection["reason"]
