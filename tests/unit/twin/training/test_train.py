from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Flag, InputError, NonsenseError, Origin
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas, stand_in_twin
from seacage.twin import Training, align, train, update

FEW = Training(high_fidelity_points=25, days=1.0, restarts=0)


def coarse():
    return stand_in_twin().cage


def trained(field, *, training=FEW, cases=40):
    campaign = stand_in_campaign(coarse(), stand_in_seas(cases))
    return train(coarse(), campaign, field, training=training)


def with_sensors(field, *names):
    return replace(field, sensors={name: field.sensors[name] for name in names})


def test_level_two_is_nearer_to_every_sensor_than_level_one_on_days_that_did_not_teach():
    twin, field = stand_in_twin(), stand_in_field(coarse())
    for column, name in enumerate(twin.sensor_names):
        pairs = align(field, name, start=twin.provenance.training_windows[name].end)
        answer = twin.predict(pairs.metocean)
        low, multi = (
            np.mean(np.abs(one.mean[:, column] - pairs.value))
            for one in (answer.sensor_low, answer.sensor)
        )
        assert multi < 0.4 * low, name


def test_the_interval_of_a_reading_holds_most_unseen_readings():
    twin, field = stand_in_twin(), stand_in_field(coarse())
    for column, name in enumerate(("depth-1", "depth-2", "depth-3")):
        pairs = align(field, name, start=twin.provenance.training_windows[name].end)
        lower, upper = twin.predict(pairs.metocean).sensor_interval()
        held = (lower[:, column] <= pairs.value) & (pairs.value <= upper[:, column])
        # One tide's window; block to block the share moves by a few per cent.
        assert 0.9 < held.mean() < 1.0


def test_a_shackle_teaches_with_its_first_window_alone():
    window = stand_in_twin().provenance.training_windows["shackle-1"]
    assert (window.end - window.start).total_seconds() < 43200.0


def test_without_a_field_record_everything_answers_at_level_one():
    twin = trained(None)
    answer = twin.predict(stand_in_seas(3))
    assert twin.origin == Origin.COMPUTED
    assert set(answer.sensor_level) == set(answer.bridle_level) == {1}
    assert answer.sensor.mean == pytest.approx(answer.sensor_low.mean)


@pytest.mark.slow
def test_a_sensor_with_too_few_sound_readings_stays_at_level_one():
    field = with_sensors(stand_in_field(coarse(), days=1.0), "depth-1", "depth-2")
    bad = field.sensors["depth-2"]
    flags = {"depth_m": np.full(len(bad), Flag.FAIL)}
    flags["depth_m"][:10] = Flag.GOOD
    broken = replace(field, sensors={**field.sensors, "depth-2": replace(bad, flags=flags)})
    twin = trained(broken)
    assert twin.predict(stand_in_seas(2)).sensor_level[:2].tolist() == [2, 1]
    assert list(twin.provenance.training_windows) == ["depth-1"]


def test_a_sensor_without_any_sound_reading_stays_at_level_one():
    field = with_sensors(stand_in_field(coarse(), days=1.0), "depth-1")
    flags = {"depth_m": np.full(len(field.sensors["depth-1"]), Flag.FAIL)}
    silent = replace(field.sensors["depth-1"], flags=flags)
    twin = trained(replace(field, sensors={"depth-1": silent}))
    assert twin.provenance.training_windows == {}
    assert twin.origin == Origin.COMPUTED


@pytest.mark.slow
def test_a_sensor_moved_to_another_bridle_is_trained_from_the_same_campaign():
    cage = coarse()
    moved = replace(
        cage, shackle=tuple(replace(one, bridle=one.bridle % 12 + 1) for one in cage.shackle)
    )
    campaign = stand_in_campaign(cage, stand_in_seas(40))
    field = with_sensors(stand_in_field(moved, days=1.0), "shackle-1")
    answer = train(moved, campaign, field, training=FEW).predict(stand_in_seas(2))
    assert np.flatnonzero(answer.bridle_level == 2).tolist() == [moved.shackles[0].bridle]


@pytest.mark.slow
def test_training_twice_with_one_seed_gives_one_twin():
    field = with_sensors(stand_in_field(coarse(), days=1.0), "depth-1", "shackle-1")
    once, twice = (trained(field).predict(stand_in_seas(5, seed=9)) for _ in range(2))
    np.testing.assert_array_equal(once.sensor.mean, twice.sensor.mean)
    np.testing.assert_array_equal(once.node_position, twice.node_position)


@pytest.mark.slow
def test_the_papers_choice_is_the_first_readings_in_a_row():
    field = with_sensors(stand_in_field(coarse(), days=1.0), "depth-1")
    spread, paper = (
        trained(field, training=replace(FEW, choice=choice)) for choice in ("spread", "paper")
    )
    pairs = align(field, "depth-1", mean_s=60.0)
    misses = [
        np.mean(np.abs(twin.predict(pairs.metocean).sensor.mean[:, 0] - pairs.value))
        for twin in (spread, paper)
    ]
    # An hour of one current teaches little about a tide.
    assert misses[0] < misses[1]


def test_waves_may_be_among_the_inputs():
    seas = stand_in_seas(40)
    random = np.random.default_rng(0)
    wavy = tuple(
        replace(sea, hs=hs, tp=None, wave_from=to)
        for sea, hs, to in zip(
            seas,
            random.uniform(0, 3, 40).tolist(),
            random.uniform(0, 360, 40).tolist(),
            strict=True,
        )
    )
    campaign = stand_in_campaign(coarse(), wavy)
    twin = train(coarse(), campaign, training=replace(FEW, inputs=("current", "waves")))
    assert twin.predict(wavy[3]).in_domain.all()
    high = replace(wavy[3], hs=6.0, tp=None)
    assert "waves up to" in twin.predict(high).reason[0]


def moved(cage):
    """The cage with its first shackle on the next bridle and one depth sensor more."""
    first, *rest = cage.shackle
    added = replace(cage.depth_sensor[0], name="depth-9")
    return replace(
        cage,
        shackle=(replace(first, bridle=first.bridle % 12 + 1), *rest),
        depth_sensor=(*cage.depth_sensor, added),
    )


@pytest.mark.slow
def test_moved_and_added_sensors_are_trained_alone_and_all_else_stays_what_it_was():
    base, cage = stand_in_twin(), moved(coarse())
    twin = train(cage, None, stand_in_field(cage), base=base, training=FEW)
    assert twin.models.bridles is base.models.bridles
    assert twin.models.shape is base.models.shape
    for name, model in base.models.upper.items():
        if name != "shackle-1":
            assert twin.models.upper[name] is model, name
            assert twin.provenance.training_windows[name] == base.provenance.training_windows[name]
    assert twin.models.upper["shackle-1"] is not base.models.upper["shackle-1"]
    assert "depth-9" in twin.models.upper
    answer = twin.predict(stand_in_seas(2))
    assert answer.bridle_level[cage.shackles[0].bridle] == 2
    assert answer.bridle_level[coarse().shackles[0].bridle] == 1
    was, now = (one.predict(stand_in_seas(5, seed=3)).sensor.mean[:, 1] for one in (base, twin))
    np.testing.assert_array_equal(now, was)


def test_a_sensor_that_left_the_cage_is_forgotten():
    cage = replace(coarse(), shackle=coarse().shackle[1:])
    twin = train(cage, None, None, base=stand_in_twin(), training=FEW)
    assert "shackle-1" not in twin.provenance.training_windows
    assert "shackle-2" in twin.provenance.training_windows


def test_a_base_of_another_cage_is_refused():
    with pytest.raises(InputError, match="by more than its sensors"):
        train(Cage.named("ace"), None, base=stand_in_twin(), training=FEW)


def test_a_base_that_asks_for_other_inputs_is_refused():
    with pytest.raises(InputError, match="inputs of the base are current, not current and waves"):
        train(
            coarse(),
            None,
            base=stand_in_twin(),
            training=replace(FEW, inputs=("current", "waves")),
        )


def test_inputs_that_nobody_measured_are_refused_by_their_key():
    training = replace(FEW, inputs=("current", "waves"))
    campaign = stand_in_campaign(coarse(), stand_in_seas(40))
    field = stand_in_field(coarse(), days=1.0)
    with pytest.raises(NonsenseError, match="buoy-1 has no hs_m, which the inputs current,waves"):
        train(coarse(), campaign, field, training=training)
    none = np.full(len(field.buoy), np.nan)
    values = {**field.buoy.values, "hs_m": none, "wave_from_deg": none}
    never = replace(field, buoy=replace(field.buoy, values=values, flags={}))
    with pytest.raises(NonsenseError, match="buoy-1 has no hs_m"):
        train(coarse(), campaign, never, training=training)


def test_a_campaign_in_still_water_teaches_no_waves():
    campaign = stand_in_campaign(coarse(), stand_in_seas(40))
    with pytest.raises(NonsenseError, match="the campaign has no waves"):
        train(coarse(), campaign, training=replace(FEW, inputs=("current", "waves")))


def test_a_campaign_or_a_base_is_needed_and_not_both():
    for given in (None, stand_in_campaign(coarse(), stand_in_seas(40))):
        with pytest.raises(InputError, match="either a campaign"):
            train(coarse(), given, base=None if given is None else stand_in_twin())


def test_new_readings_mend_level_two_and_leave_level_one_and_others_alone():
    base, field = stand_in_twin(), stand_in_field(coarse(), days=4.0)
    fresh = with_sensors(field, "depth-3")
    twin = update(base, fresh)
    assert twin.models.bridles is base.models.bridles
    assert twin.models.shape is base.models.shape
    for name in set(base.models.upper) - {"depth-3"}:
        assert twin.models.upper[name] is base.models.upper[name]
    window, before = (one.provenance.training_windows["depth-3"] for one in (twin, base))
    assert window.points == before.points + 60
    assert window.end > before.end
    pairs = align(field, "depth-3", start=before.end)
    column = base.sensor_names.index("depth-3")
    misses = [
        np.mean(np.abs(one.predict(pairs.metocean).sensor.mean[:, column] - pairs.value))
        for one in (base, twin)
    ]
    assert misses[1] < misses[0]


def test_without_new_readings_an_update_changes_nothing():
    base, field = stand_in_twin(), stand_in_field(coarse(), days=1.0)
    twin = update(base, with_sensors(field, "depth-1", "depth-2"))
    assert twin.provenance == base.provenance
    assert twin.models.upper == base.models.upper


@pytest.mark.slow
def test_a_short_window_is_calibrated_by_other_sensors_and_a_long_one_by_itself():
    windows = stand_in_twin().provenance.training_windows
    assert windows["depth-1"].calibrated == "own"
    assert stand_in_twin().models.upper["depth-1"].spread.by == "own"
    longer = train(
        coarse(),
        None,
        with_sensors(stand_in_field(coarse()), "depth-1", "shackle-1"),
        base=replace(stand_in_twin(), models=replace(stand_in_twin().models, upper={})),
        training=replace(FEW, days=3.5),
    )
    assert longer.provenance.training_windows["shackle-1"].calibrated == "carried"


@pytest.mark.slow
def test_a_short_window_without_others_is_calibrated_by_its_own_hours():
    field = with_sensors(stand_in_field(coarse(), days=1.0), "shackle-1")
    assert trained(field).provenance.training_windows["shackle-1"].calibrated == "own"


@pytest.mark.slow
def test_the_papers_choice_is_a_few_minutes_of_depth_and_a_few_seconds_of_load():
    field = stand_in_field(coarse(), days=1.0, sensor_s=2.0)
    field = with_sensors(field, "depth-1", "shackle-1")
    windows = trained(
        field, training=replace(FEW, choice="paper", high_fidelity_points=300)
    ).provenance.training_windows
    # Whether so little is believed is another matter; what is believed spans no more.
    spans = {"depth-1": (150, 300.0), "shackle-1": (5, 10.0)}
    for name, window in windows.items():
        points, span = spans[name]
        assert window.points == points
        assert (window.end - window.start).total_seconds() <= span
        assert window.calibrated == "none"
    assert windows


def test_cases_that_did_not_converge_teach_nothing():
    campaign = stand_in_campaign(coarse(), stand_in_seas(40))
    result = np.zeros(40, dtype=int)
    result[5:] = 2
    lost = replace(campaign, result=result)
    with pytest.raises(InputError, match="5 of the campaign's 40 cases converged"):
        train(coarse(), lost)


def test_the_cage_must_be_the_one_that_was_simulated():
    campaign = stand_in_campaign(coarse(), stand_in_seas(40))
    with pytest.raises(InputError, match="81 nodes, that of ace 321"):
        train(Cage.named("ace"), campaign)


def test_training_reports_how_far_it_is():
    steps = []
    campaign = stand_in_campaign(coarse(), stand_in_seas(40))
    train(coarse(), campaign, training=FEW, progress=lambda *step: steps.append(step))
    assert steps == [("train bridles", 1, 2), ("train shape", 2, 2)]
