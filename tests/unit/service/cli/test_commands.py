import csv
import json
import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
import typer
from safetensors.numpy import load_file
from typer.testing import CliRunner

import seacage
from seacage.cage import Cage
from seacage.service._auth._token_store import Tokens
from seacage.service._cli._app import app
from seacage.service._store._store import open_store
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas, stand_in_twin
from seacage.twin import Twin
from stores import put, sample, schema

FROZEN = Path(__file__).parents[3] / "frozen" / "0.1.0"
COMMANDS = [
    "cage new",
    "cage check",
    "cage draw",
    "settle",
    "simulate",
    "campaign run",
    "campaign status",
    "campaign finish",
    "campaign export",
    "campaign import",
    "campaign slurm",
    "field virtual",
    "field import",
    "field check",
    "train",
    "if-parted",
    "score",
    "study paper",
    "study bench",
    "study benchmarks",
    "study fidelity",
    "serve",
    "replay",
    "clearance",
    "inspect-path",
    "publish",
    "token new",
    "token list",
    "token revoke",
    "twin replace",
    "archive write",
    "archive read",
    "archive check",
    "backup",
    "restore",
    "config check",
    "config show",
    "doctor",
]


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)


def answer(*words):
    """What a program gets of a command that ends well."""
    result = run(*words, "--json")
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout)


@pytest.fixture(autouse=True)
def own_logs(monkeypatch):
    """Commands keep their hands off the process's logs: their stream closes with the test."""
    monkeypatch.setattr("seacage.service._logs.begin_logs", lambda _: None)


@pytest.fixture
def small_cage(tmp_path):
    path = tmp_path / "small.toml"
    Cage.named("ace").altered(mesh={"spokes": 8}).write(path)
    return path


@pytest.fixture(scope="session")
def twin(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twin") / "twin"
    stand_in_twin().write(folder)
    return folder


@pytest.fixture
def buoy(tmp_path):
    """Four rows: good, impossible, faster than was learned, and one whose direction is 360."""
    path = tmp_path / "buoy.csv"
    path.write_text(
        "time,current_speed_m_s,current_to_deg\n"
        "2020-03-01T00:00:00Z,0.4,80\n"
        "2020-03-01T00:12:00Z,0.4,412\n"
        "2020-03-01T00:24:00Z,1.3,80\n"
        "2020-03-01T00:36:00Z,0.5,360\n"
    )
    return path


@pytest.mark.parametrize("command", COMMANDS)
def test_help_teaches_with_an_example_and_offers_json(command):
    result = run(*command.split(), "--help").stdout
    assert "Example" in result
    assert f"seacage {command}" in result
    assert "--json" in result


def test_no_command_is_left_out_of_these_tests():
    named = set()
    for name, command in typer.main.get_command(app).commands.items():
        inner = getattr(command, "commands", None)
        named |= {f"{name} {one}" for one in inner} if inner else {name}
    assert named == set(COMMANDS)


def test_every_option_and_argument_has_its_help():
    groups = [typer.main.get_command(app)]
    for group in groups:
        for command in group.commands.values():
            groups += [command] if getattr(command, "commands", None) else []
            unexplained = [one.name for one in command.params if not one.help]
            assert unexplained == [], command.name


def test_the_exit_codes_are_documented():
    assert "1 the input was refused" in run("--help").stdout


def test_a_word_that_is_not_understood_ends_with_2():
    assert run("settle", "--speed", "1").exit_code == 2


def test_a_sea_state_settles_into_a_summary_and_a_file(small_cage, tmp_path):
    import xarray

    out = tmp_path / "response.nc"
    sea = ("--current-speed", 0.4, "--current-to", 90)
    reply = answer("settle", *sea, "--cage", small_cage, "--out", out)
    assert reply["result"] == 0
    assert reply["origin"] == "computed"
    assert reply["net_force_kn"][0] > 5.0
    with xarray.open_dataset(out) as kept:
        assert kept.bridle_tension.attrs["units"] == "N"
        assert float(kept.bridle_tension[0]) == pytest.approx(
            1000.0 * reply["bridle_tension_kn"]["bridle-1"], abs=1.0
        )


def test_a_refused_sea_state_ends_with_1_and_one_sentence(small_cage):
    result = run("settle", "--current-speed", 0.4, "--current-to", 412, "--cage", small_cage)
    assert result.exit_code == 1
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1
    assert "412 deg is outside [0, 360]" in result.stderr


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("water_depth_m = 191.0", "water_depth_m = 6.0", "hangs 31 m deep in water of 6 m"),
        ("side_m = 85.0", "side_m = 45.0", "no room for a collar"),
        ("length_offset_m = [0.0, ", "length_offset_m = [", "12 bearings_deg but 11"),
        ("tip_depth_m", "tip_deph_m", "did you mean 'tip_depth_m'?"),
    ],
)
@pytest.mark.parametrize("command", ["settle", "simulate"])
def test_a_cage_file_that_makes_no_sense_ends_with_2_and_its_name(
    small_cage, command, old, new, message
):
    small_cage.write_text(small_cage.read_text().replace(old, new))
    sea = ("--current-speed", 0.4, "--current-to", 90)
    result = run(command, *sea, "--cage", small_cage)
    assert result.exit_code == 2
    assert result.stderr.startswith(f"seacage: {small_cage}")
    assert message in result.stderr
    assert result.stderr.count("\n") == 1


def test_a_bridle_that_a_spoke_moves_is_warned_of_in_the_result_and_on_the_shell(tmp_path):
    import xarray

    path, out = tmp_path / "mine.toml", tmp_path / "mine.nc"
    text = Cage.named("ace").altered(mesh={"spokes": 16}).to_toml()
    path.write_text(text.replace("bearings_deg = [67.5", "bearings_deg = [50.0"))
    words = ("settle", "--current-speed", 0.4, "--current-to", 90, "--cage", path, "--out", out)
    result = run(*words, "--json")
    assert result.exit_code == 0
    (warning,) = json.loads(result.stdout)["warnings"]
    assert "moves bridle-1 from 50° to 45°." in warning
    assert result.stderr == f"seacage: warning: {warning}\n"
    with xarray.open_dataset(out) as kept:
        assert kept.attrs["comment"] == warning


def test_a_cage_of_another_topology_settles_and_is_simulated(tmp_path, pytestconfig):
    path = pytestconfig.rootpath / "validation" / "second_solver.toml"
    sea = ("--current-speed", 0.3, "--current-to", 90, "--cage", path, "--json")
    for words in (("settle", *sea), ("simulate", "--duration", 5, "--spin-up", 5, *sea)):
        result = run(*words, "--out", tmp_path / "out.nc")
        assert result.exit_code == 0, result.stderr
        answer = json.loads(result.stdout)
        assert answer["cage"] == "second-solver"
        assert answer["depth_m"] == {}
        assert len(answer["bridle_tension_kn"]) == 18
    refused = run("simulate", *sea, "--mooring-draws", 2)
    assert refused.exit_code == 2
    assert "no twin, drawn mooring or animation. Give a cage's file." in refused.stderr


def test_waves_that_a_field_never_had_are_refused_with_its_folder(tmp_path, monkeypatch):
    cage = stand_in_twin().cage
    campaign = stand_in_campaign(cage, stand_in_seas(30))
    monkeypatch.setattr("seacage.records.read_campaign", lambda _: campaign)
    stand_in_field(cage, days=1.0).write(tmp_path / "field")
    words = ("--campaign", tmp_path, "--field", tmp_path / "field", "--out", tmp_path / "twin")
    result = run("train", *words, "--inputs", "current,waves")
    assert result.exit_code == 2
    assert f"{tmp_path / 'field'} with {tmp_path}: train: buoy-1 has no hs_m" in result.stderr
    assert not (tmp_path / "twin").exists()


def test_a_twin_is_signed_with_the_key_of_a_file(tmp_path, monkeypatch):
    monkeypatch.setattr("seacage.twin.train", lambda *_, **__: stand_in_twin())
    stand_in_twin().write(tmp_path / "base")
    key = tmp_path / "key"
    key.write_bytes(bytes(range(32)))
    words = ("train", "--base", tmp_path / "base", "--out", tmp_path / "twin", "--sign", key)
    key.chmod(0o644)
    assert run(*words).exit_code == 1
    assert not (tmp_path / "twin").exists()
    key.chmod(0o600)
    assert run(*words).exit_code == 0
    assert Twin.read(tmp_path / "twin", key=bytes(range(32)))


def test_settings_with_a_limit_that_is_no_number_end_with_2_and_the_files_name(tmp_path):
    (tmp_path / "farm.toml").write_text("[alarms.load]\nraise_at = inf\n")
    for command in (("serve",), ("config", "check")):
        result = run(*command, "--config", tmp_path / "farm.toml")
        assert result.exit_code == 2
        assert "farm.toml: alarms.load.raise_at = inf is no finite number" in result.stderr


def test_a_campaign_runs_reports_how_far_it_is_and_becomes_netcdf(small_cage, tmp_path):
    store, out = tmp_path / "small.zarr", tmp_path / "small.nc"
    short = ("--duration", 10, "--spin-up", 5, "--ramp", 5, "--cage", small_cage, "--workers", 1)
    reply = answer("campaign", "run", store, "--cases", 3, "--seed", 1, *short)
    assert (reply["total"], reply["done"], reply["plan"]) == (3, 3, "default")
    assert reply["simulated_s_per_core_second"] > 0.0
    assert answer("campaign", "status", store) == reply
    assert answer("campaign", "finish", store) == reply
    assert answer("campaign", "export", store, out) == {"written": str(out)}
    assert out.stat().st_size > 1000


def test_the_status_of_no_campaign_is_refused(tmp_path):
    assert run("campaign", "status", tmp_path / "none.zarr").exit_code == 1


def test_a_foreign_table_is_imported_and_its_bad_values_are_counted(buoy, tmp_path):
    out = tmp_path / "buoy-1.nc"
    reply = answer("field", "import", buoy, out)
    assert reply["written"] == str(out)
    assert reply["streams"]["buoy-1"]["flags"]["current_to_deg"]["fail"] == 1
    assert answer("field", "check", out)["streams"] == reply["streams"]


def refused_import(tmp_path, *words):
    """What an import says that is refused, and that it wrote nothing."""
    result = CliRunner().invoke(app, ["field", "import", *map(str, words), str(tmp_path / "o.nc")])
    assert result.exit_code != 0
    assert not (tmp_path / "o.nc").exists()
    return result.stderr


def test_a_logger_over_the_change_of_clocks_is_read_once_its_zone_is_named(tmp_path):
    logger, chosen = tmp_path / "logger.csv", tmp_path / "map.toml"
    clock = [f"28.10.2018;0{hour}:00;0,{at}" for at, hour in enumerate((1, 2, 2, 3, 4), start=1)]
    logger.write_text("Dato;Kl;Fart (m/s)\n" + "\n".join(clock) + "\n")
    assert "--inspect" in refused_import(tmp_path, logger)
    answer("field", "import", logger, chosen, "--inspect")
    begun = chosen.read_text().replace('origin = "?"', 'origin = "measured"')
    chosen.write_text(begun.replace('zone = "?"', 'zone = "+01:00"'))
    told = " ".join(refused_import(tmp_path, logger, "--columns", chosen).split())
    assert "'28.10.2018 02:00' is where the clock steps by an hour" in told
    chosen.write_text(begun.replace('zone = "?"', 'zone = "Europe/Oslo"'))
    reply = answer("field", "import", logger, tmp_path / "o.nc", "--columns", chosen)
    assert reply["streams"]["buoy-1"]["rows"] == 5
    import xarray

    with xarray.open_dataset(tmp_path / "o.nc") as kept:
        assert [str(time)[11:13] for time in kept.time.values] == ["23", "00", "01", "02", "03"]


def test_options_answer_what_a_shipped_map_leaves_open(tmp_path):
    row = "10 28 2018 0{} 00 00" + " 0" * 17 + " 0.{} 356\n"
    (tmp_path / "a.dat").write_text("".join(row.format(hour, hour) for hour in range(1, 6)))
    words = (tmp_path / "a.dat", "--columns", "nortek_aquadopp_enu_26")
    assert "nortek_aquadopp_enu_25" in refused_import(tmp_path, *words)
    words = (tmp_path / "a.dat", "--columns", "nortek_aquadopp_enu_25")
    assert "--zone and --declination-deg" in refused_import(tmp_path, *words)
    words = (*words, "--declination-deg", "4.5")
    assert "answers --zone." in " ".join(refused_import(tmp_path, *words).split())
    assert "--origin is for NetCDF" in refused_import(tmp_path, *words, "--origin", "measured")
    told = refused_import(tmp_path, *words, "--zone", "Europe/Oslo")
    assert "nothing tells summer time" in " ".join(told.split())
    reply = answer("field", "import", words[0], tmp_path / "o.nc", *words[1:], "--zone", "+01:00")
    assert "4.5 deg of declination are added to 25." in reply["streams"]["buoy-1"]["notes"]


def test_an_option_for_what_a_map_says_is_refused(tmp_path, buoy):
    assert "--zone is for a map that leaves it open" in refused_import(
        tmp_path, buoy, "--zone", "UTC"
    )


def test_a_field_record_is_checked_stream_by_stream(tmp_path):
    stand_in_field(stand_in_twin().cage, days=1.0).write(tmp_path / "field")
    streams = answer("field", "check", tmp_path / "field")["streams"]
    assert streams.keys() == {"buoy-1", *stand_in_twin().sensor_names}
    assert streams["depth-1"]["origin"] == "virtual field"


def test_an_empty_file_is_refused_with_its_name(tmp_path):
    (tmp_path / "empty.csv").write_text("")
    result = run("field", "check", tmp_path / "empty.csv")
    assert result.exit_code == 1
    assert "empty.csv" in result.stderr


def test_every_row_of_a_record_is_answered_or_says_why_not(buoy, twin, tmp_path):
    out = tmp_path / "answers.csv"
    reply = answer("replay", buoy, "--twin", twin, "--out", out)
    assert (reply["rows"], reply["valid"], reply["extrapolating"]) == (4, 3, 1)
    assert reply["ticks_per_second"] > 0.0
    with out.open() as file:
        rows = list(csv.DictReader(file))
    computed = [name for name in rows[0] if name.endswith(("_kn", "_m")) or "fraction" in name]
    assert len(computed) > 8 * 6 + 12 * 6
    low = [name for name in rows[0] if "_low_lower_" in name or "_low_upper_" in name]
    assert len(low) == 2 * 20
    for row in rows:
        good = row["valid"] == "True"
        assert all((row[name] != "") is good for name in computed if name not in low)
        assert {row[name] for name in low} == {""}
        assert (row["shape_level"], row["shape_interval_reason"]) == ("2", "")
        assert {row[f"bridle-{k}_level"] for k in (1, 12)} == {"1"}
        assert row["bridle-7_level"] == "2"
    assert "flagged 4" in rows[1]["reason"]
    assert rows[2]["extrapolating"] == "True"
    for name in ("bridle-1", "shape"):
        assert [row[f"{name}_in_domain"] for row in rows] == ["True", "False", "False", "True"]
    # Its shackle was never there in water that ran north.
    inside = [row["bridle-7_in_domain"] for row in rows]
    assert inside == ["True", "False", "False", "False"]
    for row in rows:
        ends = [float(row[name] or 0.0) for name in computed if "_lower_" in name]
        assert min(ends) >= 0.0


def test_step_by_step_and_in_blocks_are_the_same_answers(buoy, twin, tmp_path):
    for name, how in (("steps", ()), ("blocks", ("--batched",))):
        answer("replay", buoy, "--twin", twin, "--out", tmp_path / f"{name}.jsonl", *how)
    steps, blocks = (
        [json.loads(line) for line in (tmp_path / f"{name}.jsonl").read_text().splitlines()]
        for name in ("steps", "blocks")
    )
    for one, other in zip(steps, blocks, strict=True):
        assert one.keys() == other.keys()
        for key, value in one.items():
            # Sums over rows may be taken in another order.
            close = pytest.approx(value, abs=2e-6) if isinstance(value, float) else value
            assert other[key] == close


def test_the_netcdf_file_holds_the_whole_shape_and_nothing_where_there_is_no_input(
    buoy, twin, tmp_path
):
    import xarray

    out = tmp_path / "answers.nc"
    answer("replay", buoy, "--twin", twin, "--out", out)
    with xarray.open_dataset(out) as kept:
        assert kept.attrs["origin"] == "virtual field"
        assert kept.sizes["node"] == stand_in_twin().cage.node_count
        assert kept.valid.values.tolist() == [1, 0, 1, 1]
        trained = kept.bridle_level.values == 2
        assert np.isfinite(kept.bridle_tension_lower.values[0]).all()
        assert np.isnan(kept["shackle_tension_low_upper"].values).all()
        known = np.isfinite(kept["node_sigma"].values).all(axis=1)
        assert known.tolist() == [True, False, True, True]
        assert kept.bridle_in_domain.values.tolist() == [
            [1] * 12,
            [0] * 12,
            [0] * 12,
            # The shackles were never there in water that ran north.
            (~trained).astype(int).tolist(),
        ]
        assert (kept.attrs["shape_level"], kept.attrs["shape_interval_reason"]) == (2, "")
        for name in ("node_position", "bridle_tension", "shackle_tension_upper", "depth"):
            finite = np.isfinite(kept[name].values).reshape(4, -1)
            assert finite.all(axis=1).tolist() == [True, False, True, True], name
            assert not finite[1].any(), name


@pytest.mark.parametrize(
    "words",
    [(), ("--twin", "TWIN"), ("--out", "a.csv"), ("--twin", "TWIN", "--out", "answers.xlsx")],
)
def test_a_replay_that_leads_nowhere_is_refused(buoy, twin, words):
    result = run("replay", buoy, *(twin if word == "TWIN" else word for word in words))
    assert result.exit_code == 1


def test_a_damaged_twin_is_refused(buoy, twin, tmp_path):
    damaged = tmp_path / "twin"
    stand_in_twin().write(damaged)
    model = damaged / "model.json"
    model.write_bytes(model.read_bytes().replace(b"1", b"2", 1))
    result = run("replay", buoy, "--twin", damaged, "--out", tmp_path / "a.csv")
    assert result.exit_code == 1
    assert not (tmp_path / "a.csv").exists()


@pytest.mark.slow
@pytest.mark.timeout(400)  # trains three times, which a crowded machine takes minutes for
def test_a_twin_is_trained_and_scored_on_what_did_not_teach_it(tmp_path, monkeypatch):
    cage = stand_in_twin().cage
    campaign = stand_in_campaign(cage, stand_in_seas(60))
    monkeypatch.setattr("seacage.records.read_campaign", lambda _: campaign)
    whole = stand_in_field(cage)
    two = {name: whole.sensors[name] for name in ("depth-1", "shackle-1")}
    replace(whole, sensors=two).write(tmp_path / "field")
    field, out = ("--field", tmp_path / "field"), ("--out", tmp_path / "twin")
    reply = answer("train", "--campaign", tmp_path, *field, *out, "--points", 30, "--days", 2)
    assert [name for name, level in reply["level"].items() if level == 2] == list(two)
    assert reply["unlike"] == ""  # one depth sensor does not show it
    scores = tmp_path / "scores"
    scored = answer("score", "--twin", tmp_path / "twin", *field, "--out", scores)
    assert [one["sensor"] for one in scored["sensors"]] == list(two)
    assert {one["origin"] for one in scored["sensors"]} == {"virtual field"}
    assert all(one["raw"]["multi_mae"] < one["raw"]["low_mae"] for one in scored["sensors"])
    assert len(list(scores.glob("*.svg"))) == 4
    # A twin of level 1 alone is the base that one sensor is then added to.
    alone, added = tmp_path / "alone", tmp_path / "added"
    answer("train", "--campaign", tmp_path, "--out", alone, "--points", 30)
    words = ("train", "--base", alone, *field, "--out", added, "--points", 30, "--days", 2)
    again = answer(*words)
    assert again["level"] == reply["level"]
    assert set(again["calibrated"]) == set(two)
    arrays = [load_file(one / "arrays.safetensors") for one in (alone, added)]
    assert arrays[0]
    for name, values in arrays[0].items():
        np.testing.assert_array_equal(arrays[1][name], values, err_msg=name)


@pytest.mark.parametrize("given", [(), ("--campaign", "HERE", "--base", "HERE")])
def test_training_wants_either_simulations_or_a_base(tmp_path, given):
    words = [tmp_path if word == "HERE" else word for word in given]
    result = run("train", *words, "--out", tmp_path / "twin")
    assert result.exit_code == 1
    assert "either --campaign" in result.stderr


def test_a_new_token_stands_alone_on_the_last_line(tmp_path):
    result = run("token", "new", "--data", tmp_path, "--scope", "ingest,read")
    assert result.exit_code == 0
    token = result.stdout.splitlines()[-1]
    assert len(token) >= 43
    assert token not in (tmp_path / "tokens.jsonl").read_text()


def test_a_token_for_nothing_that_exists_is_refused(tmp_path):
    result = run("token", "new", "--data", tmp_path, "--scope", "write")
    assert result.exit_code == 1
    assert "The scopes are" in result.stderr


def test_the_doctor_finds_the_physics_sound(tmp_path):
    reply = answer("doctor", "--data", tmp_path)
    assert reply["ok"]
    physics = next(one for one in reply["findings"] if one["what"] == "Physics kernel")
    assert physics["state"] == "ok"


def test_the_doctor_names_a_line_that_is_no_token(tmp_path):
    Tokens(tmp_path).mint(["read"], keep=True)
    assert answer("doctor", "--data", tmp_path)["ok"]
    with (tmp_path / "tokens.jsonl").open("a") as file:
        file.write('{"sha256": "01')
    result = run("doctor", "--data", tmp_path, "--json")
    assert result.exit_code == 3
    finding = next(one for one in json.loads(result.stdout)["findings"] if one["what"] == "Tokens")
    assert (finding["state"], "line 2" in finding["said"]) == ("wrong", True)


def test_the_doctor_counts_the_rows_that_nobody_can_verify(tmp_path):
    copy = tmp_path / "old.sqlite"
    shutil.copy(FROZEN / "store.sqlite", copy)
    before = copy.read_bytes()
    (rows,) = [
        one["said"]
        for one in answer("doctor", "--data", tmp_path, "--store", copy)["findings"]
        if one["what"] == "Stored rows"
    ]
    assert "0 rows are as they were written" in rows
    assert "unverified" in rows
    assert copy.read_bytes() == before


def test_the_doctor_reports_a_row_that_the_disk_has_changed(tmp_path):
    place = tmp_path / "samples.sqlite"
    with closing(open_store(place)) as store:
        put(store, sample(0), sample(1))
    assert answer("doctor", "--data", tmp_path)["ok"]
    with closing(sqlite3.connect(place)) as disk, disk:
        disk.execute("UPDATE sample SET readings = replace(readings, '14', '94')")
    result = run("doctor", "--data", tmp_path, "--json")
    assert result.exit_code == 3
    assert "2 stored rows are not as they were written" in result.stdout


@pytest.mark.postgres
def test_the_doctor_says_whether_the_server_keeps_checksums(postgres, tmp_path):
    with schema(postgres) as url:
        reply = answer("doctor", "--data", tmp_path, "--store", url)["findings"]
    (rows,) = [one["said"] for one in reply if one["what"] == "Stored rows"]
    assert "data_checksums of the server are o" in rows


def test_serving_beyond_this_machine_takes_a_decision(tmp_path, twin):
    result = run("serve", "--data", tmp_path, "--twin", twin, "--host", "0.0.0.0")
    assert result.exit_code == 1
    assert "--insecure-http" in result.stderr


def test_a_port_that_is_taken_is_named_before_any_work(tmp_path, twin, idle):
    port = idle.address.rsplit(":", 1)[1]
    result = run("serve", "--data", tmp_path, "--twin", twin, "--port", port)
    assert result.exit_code == 3
    assert f"cannot listen on 127.0.0.1:{port}" in result.stderr


def test_a_data_folder_that_takes_no_files_is_refused_plainly(tmp_path, twin):
    (tmp_path / "var").write_text("a file where the folder should be")
    result = run("serve", "--data", tmp_path / "var", "--twin", twin, "--port", 0)
    assert result.exit_code in (1, 3)
    assert result.stderr.count("\n") == 1
    assert str(tmp_path / "var") in result.stderr


@pytest.mark.parametrize("words", [("--port", "70000"), ("--demo", "--twin", "TWIN")])
def test_settings_that_cannot_be_are_refused(tmp_path, twin, words):
    words = [twin if word == "TWIN" else word for word in words]
    assert run("serve", "--data", tmp_path, *words).exit_code == 1


def test_the_version_is_that_of_the_package():
    answer = run("--version")
    assert answer.exit_code == 0
    assert answer.stdout == f"seacage {version('seacage')}\n"
    assert seacage.__version__ == version("seacage")
    assert Path(seacage.__file__).with_name("py.typed").is_file()
