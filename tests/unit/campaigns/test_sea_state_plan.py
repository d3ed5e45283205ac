"""Plans: which sea states a campaign visits."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from seacage.campaigns import Plan
from seacage.conventions import InputError
from seacage.ocean import SeaState


def columns(plan: Plan) -> np.ndarray:
    return np.array([(s.current_speed, s.current_to, s.hs, s.tp, s.wave_from) for s in plan.seas])


def test_a_sample_fills_the_papers_ranges() -> None:
    speed, to, hs, tp, wave_from = columns(Plan.sample(1, 1000)).T
    for values, top in ((speed, 1.0), (to, 360.0), (hs, 3.0), (wave_from, 360.0)):
        assert values.min() >= 0.0
        assert values.max() <= top
        # A low-discrepancy sequence leaves no tenth of the range emptier than this.
        counts, _ = np.histogram(values, 10, (0.0, top))
        assert counts.min() >= 95
        assert counts.max() <= 105
    np.testing.assert_allclose(tp, 5.0 * np.sqrt(hs), rtol=1e-12)
    assert tp.max() < 8.67


def test_the_seed_decides_and_a_longer_draw_begins_like_a_shorter_one() -> None:
    assert Plan.sample(1, 100) == Plan.sample(1, 100)
    assert Plan.sample(1, 100).seas == Plan.sample(1, 300).seas[:100]
    assert Plan.sample(1, 100).seas != Plan.sample(2, 100).seas


def test_a_range_that_is_a_point_leaves_the_other_draws_alone() -> None:
    still, waves = Plan.sample(3, 50, hs=(0.0, 0.0)), Plan.sample(3, 50)
    assert {sea.hs for sea in still.seas} == {0.0}
    assert [s.current_speed for s in still.seas] == [s.current_speed for s in waves.seas]


def test_the_default_plan_leaves_the_papers_curve_of_periods() -> None:
    plan = Plan.named("default", 1, 500)
    _, _, hs, tp, _ = columns(plan).T
    ratio = tp / (5.0 * np.sqrt(hs))
    # The period is the ratio times a root, and here divided by it again.
    assert 0.8 - 1e-12 <= ratio.min() < 0.82
    assert 2.18 < ratio.max() <= 2.2 + 1e-12
    assert plan.name == "default"
    assert Plan.named("current", 1, 500).seas == Plan.sample(1, 500, hs=(0.0, 0.0)).seas


def test_a_grid_holds_every_combination() -> None:
    plan = Plan.grid(current_speed=(0.2, 0.4), current_to=(0.0, 90.0, 180.0), hs=(1.0,))
    assert [(s.current_speed, s.current_to) for s in plan.seas] == [
        (0.2, 0.0), (0.2, 90.0), (0.2, 180.0), (0.4, 0.0), (0.4, 90.0), (0.4, 180.0),
    ]  # fmt: skip
    assert {s.tp for s in plan.seas} == {5.0}


def test_a_grid_may_leave_the_papers_curve_of_periods() -> None:
    plan = Plan.grid(
        current_speed=(0.2,), current_to=(0.0,), hs=(1.0, 4.0), period_ratio=(1.0, 1.5), seed=3
    )
    assert [(s.hs, s.tp) for s in plan.seas] == [(1.0, 5.0), (1.0, 7.5), (4.0, 10.0), (4.0, 15.0)]
    assert plan.seed == 3


def test_own_ranges_take_the_place_of_a_named_plans() -> None:
    plan = Plan.named("default", 1, 50, ranges={"hs": (0.5, 1.0)})
    _, _, hs, _, _ = columns(plan).T
    assert 0.5 <= hs.min() < hs.max() <= 1.0
    ranges = {"hs": (0.5, 1.0), "period_ratio": (0.8, 2.2)}
    assert plan.seas == Plan.sample(1, 50, **ranges).seas
    assert plan.name == "default, other hs"


def test_a_plan_survives_its_file(tmp_path: Path) -> None:
    plan = Plan.sample(7, 20, duration=600.0, period_ratio=(0.8, 2.2))
    plan.write(tmp_path / "plan.json")
    again = Plan.read(tmp_path / "plan.json")
    assert again == plan
    assert again.sha256 == plan.sha256
    assert "current_speed_m_s" in json.loads(plan.to_json())["cases"][0]


def test_the_hash_knows_every_part() -> None:
    plan = Plan.sample(7, 20)
    others = [
        Plan.sample(7, 21),
        Plan.sample(8, 20),
        Plan.sample(7, 20, duration=60.0),
        Plan.sample(7, 20, name="mine"),
    ]
    assert len({plan.sha256, *(other.sha256 for other in others)}) == 5


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"cases": 0}, "cases = 0"),
        ({"seed": -1}, "seed = -1 is negative"),
        ({"duration": 0.0}, "duration = 0 s"),
        ({"duration": math.nan}, "duration = nan s"),
        ({"current_speed": (0.5, 0.2)}, r"current_speed = \(0.5, 0.2\) m/s is no range"),
        ({"current_speed": (0.0, 50.0)}, "3 at most"),
        ({"current_to": (0.0, 400.0)}, "current_to"),
        ({"hs": (-1.0, 2.0)}, "hs"),
        ({"hs": (0.0, math.inf)}, "hs"),
        ({"period_ratio": (0.2, 1.0)}, "steepness"),
    ],
)
def test_an_impossible_sample_is_refused(options: dict[str, object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        Plan.sample(**{"seed": 1, "cases": 8, **options})  # type: ignore[arg-type]


def test_a_name_that_no_plan_has_is_answered_with_those_there_are() -> None:
    with pytest.raises(InputError, match="there are: paper, default, current"):
        Plan.named("papper", 1, 10)


def test_an_empty_plan_is_refused() -> None:
    with pytest.raises(InputError, match="no sea states"):
        Plan.listed([])


@pytest.mark.parametrize(
    "text",
    [
        "not json",
        "[]",
        '{"name": "a", "duration_s": 1, "seed": 0}',
        '{"name": "a", "duration_s": 1, "seed": 0, "cases": [{"current_speed": 1}]}',
    ],
)
def test_a_file_that_is_no_plan_is_refused(text: str) -> None:
    with pytest.raises(InputError, match=r"this is no (plan|JSON)"):
        Plan.from_json(text)


def test_a_bad_sea_state_in_a_file_is_refused_as_anywhere() -> None:
    text = Plan.listed([SeaState(current_speed=0.5, current_to=90.0)]).to_json()
    with pytest.raises(InputError, match=r"case 0: .*412 deg"):
        Plan.from_json(text.replace("90.0", "412.0"))


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"plan\.json: the file cannot be read"):
        Plan.read(tmp_path / "plan.json")


HEADER = "current_speed_m_s,current_to_deg,hs_m,tp_s,wave_from_deg\n"


def table(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "seas.csv"
    path.write_text(text, "utf-8")
    return path


def test_a_table_is_a_plan_of_its_rows(tmp_path: Path) -> None:
    # With the mark that spreadsheets put first, spaces, an empty line and empty cells.
    text = (
        "\ufeff" + HEADER.replace(",", ", ") + "0.3, 90, 1.44, 6.5, 270\n\n0.5,360,1.0,,\n0,0,,,\n"
    )
    plan = Plan.table(table(tmp_path, text), seed=4, duration=60.0)
    assert plan.seas == (
        SeaState(current_speed=0.3, current_to=90.0, hs=1.44, tp=6.5, wave_from=270.0),
        SeaState(current_speed=0.5, current_to=0.0, hs=1.0),
        SeaState(current_speed=0.0, current_to=0.0),
    )
    assert (plan.name, plan.seed, plan.duration) == ("seas", 4, 60.0)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "the file is empty"),
        ("current_speed,current_to_deg\n1,2\n", "its columns are current_speed, current_to_deg"),
        ("current_speed_m_s,hs_m\n1,2\n", "at least current_speed_m_s and current_to_deg"),
        (HEADER.replace("tp_s", "hs_m"), "the column 'hs_m' twice"),
        (HEADER + "0.3,90,1,6.5\n", "line 2: 4 cells in a table of 5 columns"),
        (HEADER + "0.3,90,1,6.5,0\n,90,1,6.5,0\n", "line 3: current_speed_m_s = '' is no finite"),
        (HEADER + "0.3,north,1,6.5,0\n", "line 2: current_to_deg = 'north' is no finite number"),
        (HEADER + "\n0.3,90,3,2.1,0\n", r"line 3: SeaState: hs = 3 m with tp = 2\.1 s has steep"),
        (HEADER + "30,90,1,6.5,0\n", r"line 2: .* 30 m/s is above 3 m/s"),
        (HEADER, "a header and no row"),
    ],
)
def test_a_table_that_is_no_plan_is_refused_with_its_row(
    tmp_path: Path, text: str, says: str
) -> None:
    with pytest.raises(InputError, match=says):
        Plan.table(table(tmp_path, text))


def test_a_table_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"seas\.csv: .*cannot be read"):
        Plan.table(tmp_path / "seas.csv")


def test_the_plan_for_loads_has_steep_and_long_seas_and_its_corners() -> None:
    speed, _, hs, tp, _ = columns(plan := Plan.named("loads", 3, 480)).T
    ratio = tp / (5.0 * np.sqrt(hs))
    assert tp.max() == pytest.approx(18.0)
    assert ratio.min() == pytest.approx(0.63)
    assert 2.9 < ratio.max() <= 3.0 + 1e-12
    corner = columns(plan)[15::16]
    assert set(corner[:, 0].tolist()) == {0.0, 1.0}
    assert set(corner[:, 2].tolist()) == {0.05, 3.0}
    assert len(np.unique(corner[:, [0, 2, 3]], axis=0)) == 8
    assert np.histogram(corner[:, 1], 4, (0.0, 360.0))[0].min() >= 5
    assert np.delete(speed, np.s_[15::16]).min() > 0.0
    assert plan.seas[:100] == Plan.named("loads", 3, 100).seas


def test_the_plan_of_profiles_has_the_shears_that_an_adcp_measured(tmp_path: Path) -> None:
    plan = Plan.named("profile", 0, 1024)
    shear = np.array([sea.shear_velocity for sea in plan.seas])
    along = np.array([sea.current_velocity / sea.current_speed for sea in plan.seas])
    to_the_right = np.column_stack([along[:, 1], -along[:, 0]])
    for way, mean, deviation in ((along, -0.11, 0.22), (to_the_right, 0.0, 0.14)):
        part = np.sum(shear * way, axis=1)
        assert part.mean() == pytest.approx(mean, abs=0.005)
        # cut at 2.5 deviations, a normal has 0.95 of its own
        assert part.std() == pytest.approx(0.95 * deviation, rel=0.03)
    plan.write(tmp_path / "plan.json")
    assert Plan.read(tmp_path / "plan.json") == plan


def test_a_plan_of_uniform_currents_is_written_as_before() -> None:
    plan = Plan.named("current", 0, 8)
    assert "shear" not in plan.to_json()
    assert plan.sha256 == "17748dfb1f99195eb3787fc76afdf70ed57865d28aaff41ca995396091367b4f"
