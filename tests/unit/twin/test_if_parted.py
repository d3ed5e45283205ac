"""What would be left if a line parted, from a twin that was trained on pairs of campaigns."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from seacage.cage import Cage, mooring_lines
from seacage.campaigns import Plan, run_campaign
from seacage.conventions import InputError, Result
from seacage.dynamics import simulate
from seacage.ocean import SeaState
from seacage.service._cli._app import app
from seacage.service._cli._train import _stores
from seacage.twin import Metocean, Training, Twin, train
from wavy import CAGE, KINDS, LOWER, SQUARE, loads_without, twin_of_damage, wavy_campaign, wavy_twin

SEA = SeaState(current_speed=0.4, current_to=40.0, hs=1.5, tp=7.0, wave_from=200.0)
LINES = mooring_lines(SQUARE, anchored=True)
QUICK = Training(restarts=0)

twin = twin_of_damage


@pytest.mark.parametrize("line", ["bridle-1", "bridle-9", "bridle-5", "frame-3", "anchor-6"])
def test_each_line_is_the_image_of_one_that_was_simulated(line: str):
    found, (mean, std) = twin().if_parted(SEA, line), loads_without(SQUARE, (SEA,), line)
    others = np.array([name != line for name in LINES.names])
    assert (found.parted, found.kinds) == ((line,), (LINES.kinds[LINES.names.index(line)],))
    np.testing.assert_allclose(found.mean[0, 0, others], mean[0, others], rtol=0.02)
    expected = (mean + 4.0 * std)[0, others]
    np.testing.assert_allclose(found.maximum_3h[0, 0, others], expected, rtol=0.04)
    assert found.mean[0, 0, ~others] == found.maximum_3h[0, 0, ~others] == 0.0


def test_all_lines_but_those_of_buoys_are_answered_at_once_and_alike():
    found = twin().if_parted([SEA, replace(SEA, current_to=300.0)])
    assert found.parted == tuple(name for name in LINES.names if not name.startswith("buoy"))
    assert found.mean.shape == (2, 24, 28)
    assert found.in_domain.all()
    alone = twin().if_parted(SEA, "anchor-6")
    at = found.parted.index("anchor-6")
    np.testing.assert_allclose(alone.maximum_3h[0, 0], found.maximum_3h[0, at], rtol=1e-9)


def test_the_most_loaded_line_is_named_and_measured_by_its_strength():
    found = twin().if_parted(SEA)
    mean, std = loads_without(SQUARE, (SEA,), "bridle-4")
    at, holds = found.parted.index("bridle-4"), [kind != "buoy line" for kind in LINES.kinds]
    named = int(found.largest_maximum_3h[0, at])
    largest = (mean + 4.0 * std)[0]
    assert largest[named] >= 0.98 * largest[holds].max()
    assert LINES.kinds[named] != "buoy line"
    share = np.nanmax(found.maximum_3h[0, at] / LINES.capacity)
    assert found.utilisation[0, at] == pytest.approx(share)
    assert (found.second_would_part == 0.0).all()
    weak = replace(SQUARE.bridles, breaking_load=0.9 * largest[:12].max())
    goes = replace(found, cage=replace(SQUARE, bridles=weak)).second_would_part
    assert goes[0, at] == 1.0


def test_a_strength_that_nobody_knows_leaves_it_open_whether_a_second_line_goes():
    found = twin().if_parted(SEA, "bridle-4")
    anchors = {"rope_breaking_load": None, "rope_material_factor": None, "rope_tn_intercept": None}
    unknown = replace(SQUARE, anchor_lines=replace(SQUARE.anchor_lines, **anchors))
    assert np.isnan(replace(found, cage=unknown).second_would_part).all()
    assert np.isfinite(replace(found, cage=unknown).utilisation).all()


def test_volume_clearance_and_drift_are_those_of_the_damaged_cage():
    campaign = wavy_campaign(cage=SQUARE)
    found = twin().if_parted(list(campaign.seas[:20]), "frame-1")
    still = twin().models.still_volume
    np.testing.assert_allclose(found.volume_share[:, 0], campaign.volume[:20] / still, rtol=0.05)
    lowest = campaign.node_position[:20, :, 2].min(axis=1) - LOWER
    clearance = SQUARE.site.water_depth + lowest
    np.testing.assert_allclose(found.clearance[:, 0], clearance, atol=1.0)
    assert (found.drift < 1.0).all()  # the collar of the formula stays where it is


def test_of_unknown_waves_there_are_means_alone_and_of_an_unknown_period_all():
    water = Metocean.of([SEA, SEA, SEA, SEA])
    hs, tp, velocity = water.hs.copy(), water.tp.copy(), water.current_velocity.copy()
    hs[0], tp[1], velocity[2] = np.nan, np.nan, np.nan
    found = twin().if_parted(replace(water, hs=hs, tp=tp, current_velocity=velocity))
    assert np.isnan(found.maximum_3h[0]).all()
    np.testing.assert_allclose(found.mean[0], found.mean[3], rtol=0.02)  # waves leave it as it is
    assert (found.utilisation[0] < found.utilisation[3]).all()  # of the mean
    np.testing.assert_allclose(found.maximum_3h[1], found.maximum_3h[3], rtol=0.2)
    assert np.isnan(found.mean[2]).all()
    assert np.isnan(found.utilisation[2]).all()
    assert np.isnan(found.second_would_part[2]).all()
    assert all(found.reason[:3])
    assert found.reason[3] == ""


def test_a_sea_beyond_the_training_has_no_number():
    found = twin().if_parted(replace(SEA, current_speed=1.6))
    assert not found.in_domain.any()
    assert np.isnan(found.maximum_3h).all()
    assert found.reason[0].startswith("Outside")


def test_a_flat_sea_leaves_the_means():
    found = twin().if_parted(replace(SEA, hs=0.0, tp=None))
    np.testing.assert_array_equal(found.maximum_3h, found.mean)
    assert found.in_domain.all()


def test_it_is_saved_with_its_twin(tmp_path: Path):
    twin().write(tmp_path / "twin")
    again = Twin.read(tmp_path / "twin")
    one, other = twin().if_parted(SEA), again.if_parted(SEA)
    for name in ("mean", "maximum_3h", "volume_share", "clearance", "drift"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-9)
    assert again.models.parted is not None
    assert [one.learned for one in again.models.parted.kinds] == [40] * 4


def test_the_shell_ranks_the_lines_of_a_saved_twin(tmp_path: Path):
    folder, sea = tmp_path / "twin", ("--current-speed", "0.4", "--current-to", "40")
    twin().write(folder)
    words = ["if-parted", "--twin", str(folder), *sea, "--hs", "1.5", "--tp", "7"]
    lines = json.loads(CliRunner().invoke(app, [*words, "--json"]).stdout)["lines"]
    assert len(lines) == 24
    table = CliRunner().invoke(app, words).stdout
    assert f"Without {lines[0]['parted']}" in table.split("\n")[0]
    assert f"kN ({lines[0]['largest_mean']['line']})" in table
    assert "a second holds" in table
    wavy_twin().write(folder)
    refused = CliRunner().invoke(app, words)
    assert (refused.exit_code, "--parted-lines" in refused.stderr) == (3, True)


def test_training_takes_stores_or_a_folder_of_them(tmp_path: Path):
    for name in ("parted/bridle-1", "parted/frame-1", ".hidden", "alone"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "zarr.json").touch()
    one, other, alone = (tmp_path / name for name in ("parted/bridle-1", "parted/frame-1", "alone"))
    assert _stores([tmp_path / "parted", alone]) == [one, other, alone]


def test_a_twin_without_it_says_what_to_do():
    with pytest.raises(InputError, match="--parted-lines"):
        wavy_twin().if_parted(SEA)
    with pytest.raises(InputError, match="has learned no such line"):
        twin().if_parted(SEA, "buoy-1")


def test_cases_without_an_answer_are_not_learned_and_are_counted():
    parted = wavy_campaign(cage=CAGE, parted=["frame-1"])
    parted.result[:5] = Result.DROWNED
    parted.lines["mean"][:5] = 1e9
    models = train(CAGE, wavy_campaign(cage=CAGE), parted=[parted], training=QUICK).models
    assert models.parted is not None
    (kind,) = models.parted.kinds
    assert (kind.learned, kind.simulated) == (35, 40)


@pytest.mark.parametrize(
    ("parted", "message"),
    [
        ([wavy_campaign(parted=[])], "no line has parted"),
        ([wavy_campaign(30, parted=["bridle-1"], cage=SQUARE)], "differs from the whole"),
        ([wavy_campaign(10, parted=["bridle-1"])], "same plan and seed"),
    ],
)
def test_campaigns_that_are_no_pairs_are_refused(parted: list, message: str):
    with pytest.raises(InputError, match=message):
        train(CAGE, wavy_campaign(), parted=parted, training=QUICK)


def test_two_lines_that_are_alike_are_refused():
    two = [wavy_campaign(30, cage=SQUARE, parted=[line]) for line in (KINDS[0], "bridle-3")]
    with pytest.raises(InputError, match="bridle-1 and bridle-3 are alike"):
        train(SQUARE, wavy_campaign(30, cage=SQUARE), parted=two, training=QUICK)


def test_a_damaged_cages_campaign_is_no_twins_own():
    with pytest.raises(InputError, match="of a cage without bridle-1"):
        train(CAGE, wavy_campaign(parted=["bridle-1"]), training=QUICK)


@pytest.mark.slow
def test_a_simulated_cage_without_a_line_bears_what_its_twin_says(tmp_path: Path):
    mesh = {"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16}
    cage, plan = Cage.named("ace").altered(mesh=mesh), Plan.named("loads", 0, 28, duration=600.0)
    settings = {"spin_up": 60.0, "second_moment": False, "workers": 1}
    whole = run_campaign(cage, plan, tmp_path / "whole", **settings)
    parted = run_campaign(cage, plan, tmp_path / "parted", parted=["bridle-2"], **settings)
    learned = train(cage, whole, parted=[parted], training=QUICK)
    sea = SeaState(current_speed=0.5, current_to=60.0, hs=1.5, tp=7.0, wave_from=80.0)
    line = "bridle-5"  # an image of bridle-2
    found = learned.if_parted(sea, line)
    before, after = (
        simulate(cage, sea, duration=600.0, spin_up=60.0, pieces=4, sample_every=None, parted=one)
        for one in ((), (line,))
    )
    bridles = slice(0, 12)
    change = after.bridle.mean - before.bridle.mean
    told = learned.predict(sea).line
    assert told is not None
    assert np.abs(np.delete(change, 4)).max() > 1e3
    error = found.mean[0, 0, bridles] - told.mean.mean[0, bridles] - change
    error[4] = 0.0
    assert np.abs(error).max() < 0.25 * np.abs(np.delete(change, 4)).max()
    largest = after.lines.tension.maximum[:24].max()
    assert found.maximum_3h[0, 0, :24].max() == pytest.approx(largest, rel=0.1)
    assert found.volume_share[0, 0] == pytest.approx(after.volume_fraction, abs=0.05)
