import csv
import io

import pytest
import xarray

from serviced import Running, at, buoy, depth

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
    monkeypatch.setattr("seacage.service._calls._downloads._PAGE", size)
    fed.post(depth(-9), depth(-8), depth(-8, stream="depth-3"))
    rows = table(fed.reader.get("/api/v1/cages/ace/samples.csv?stream=depth-2"))
    assert [row["t"][14:16] for row in rows] == ["45", "51", "52"]


def test_a_span_and_a_stream_choose_the_rows(fed: Running):
    asked = {"stream": "buoy-1", "from": at(-20), "to": at(-10)}
    rows = table(fed.reader.get("/api/v1/cages/ace/samples.csv", params=asked))
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


@pytest.mark.parametrize("name", ["samples.csv", "history.csv", "history.nc"])
def test_where_nothing_was_heard_a_file_is_empty_and_whole(idle: Running, name):
    assert idle.reader.get(f"/api/v1/cages/ace/{name}", timeout=PATIENCE_S).status_code == 200


def test_without_netcdf_a_service_says_what_to_ask_instead(idle: Running, monkeypatch):
    monkeypatch.setattr("seacage.service._calls._downloads.find_spec", lambda _: None)
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
    asked = {"stream": "buoy-1", "key": "current_speed_m_s", "width_s": 600}
    said = fed.reader.get("/api/v1/cages/ace/aggregates", params=asked).json()
    assert said["aggregates"] == [
        {"t": f"2020-02-01T11:{minute}:00Z", "count": 1, "mean": 0.5, "least": 0.5, "most": 0.5}
        for minute in (30, 50)
    ]


@pytest.mark.parametrize(
    "odd", [{"width_s": 61}, {"key": "current_to_deg"}, {"key": "mood"}, {"limit": 10_001}]
)
def test_aggregates_that_are_not_kept_are_refused(idle: Running, odd):
    asked = {"stream": "buoy-1", "key": "current_speed_m_s"} | odd
    assert idle.reader.get("/api/v1/cages/ace/aggregates", params=asked).status_code == 422


@pytest.mark.parametrize("at", ["0001-01-01T00:00:00Z", "9999-12-31T23:59:59.999999Z"])
@pytest.mark.parametrize("what", ["state", "shape", "frame", "latest"])
def test_the_ends_of_all_time_are_answered_without_a_number(idle: Running, what, at):
    assert idle.reader.get(f"/api/v1/cages/ace/{what}", params={"at": at}).is_success


def test_a_sample_from_before_all_clocks_is_rejected_with_a_reason(idle: Running):
    sample = depth() | {"t": "1950-01-01T00:00:00Z"}
    (rejection,) = idle.post(sample).json()["rejected"]
    assert "before 1970" in rejection["reason"]
