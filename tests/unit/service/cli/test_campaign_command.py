"""Which campaign the words of a shell ask for, and how it is told."""

import json
import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

from seacage.campaigns import CampaignStatus, Plan
from seacage.records import read_campaign
from seacage.service._cli._app import app
from seacage.service._cli._plans import PlanOptions
from seacage.testing import stand_in_campaign, stand_in_seas
from simulators import write_results
from wavy import CAGE


def planned(**given):
    return PlanOptions(**given).read()


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)


def refusal(*words):
    result = run("campaign", "run", "never.zarr", *words)
    assert result.exit_code == 1
    assert result.stderr.count("\n") == 1
    return result.stderr


@pytest.mark.parametrize("name", ["paper", "default", "current"])
def test_a_plan_by_name_draws_a_thousand_half_hours(name):
    assert planned(plan=name) == Plan.named(name, 0, 1000)


def test_ranges_replace_the_plans_own():
    plan = planned(
        ranges=["hs_m=0.5,1", "current_speed_m_s=0.2,0.4"], cases=8, seed=3, duration=60.0
    )
    ranges = {"hs": (0.5, 1.0), "current_speed": (0.2, 0.4)}
    assert plan == Plan.named("default", 3, 8, duration=60.0, ranges=ranges)
    assert plan.name == "default, other hs and current_speed"


def test_a_grid_is_spanned_by_numbers_or_by_their_count():
    grid = ["current_speed_m_s=0:1:3", "current_to_deg=10,20", "hs_m=1", "period_ratio=1.5"]
    plan = planned(grid=grid)
    assert [(sea.current_speed, sea.current_to) for sea in plan.seas] == [
        (0.0, 10.0), (0.0, 20.0), (0.5, 10.0), (0.5, 20.0), (1.0, 10.0), (1.0, 20.0)
    ]  # fmt: skip
    assert {(sea.hs, sea.tp) for sea in plan.seas} == {(1.0, 7.5)}


def test_a_table_of_seas_is_a_plan(tmp_path: Path):
    (tmp_path / "winter.csv").write_text("current_speed_m_s,current_to_deg\n0.3,90\n")
    plan = planned(listed=tmp_path / "winter.csv", seed=2, duration=60.0)
    assert (plan.name, len(plan), plan.seed, plan.duration) == ("winter", 1, 2, 60.0)


def test_a_written_plan_is_taken_as_it_is_but_for_what_is_given(tmp_path: Path):
    plan = Plan.sample(7, 5, duration=600.0)
    plan.write(tmp_path / "plan.json")
    assert planned(plan=str(tmp_path / "plan.json")) == plan
    longer = planned(plan=str(tmp_path / "plan.json"), duration=900.0, seed=0)
    assert (longer.seas, longer.duration, longer.seed) == (plan.seas, 900.0, 0)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--plan", "papper"), "no plan 'papper'; there are: paper, default, current"),
        (("--plan", "none.json"), "none.json: the file cannot be read"),
        (("--range", "hs=0,2"), "Keys: current_speed_m_s, current_to_deg, hs_m"),
        (("--range", "hs_m=2"), "expected two numbers"),
        (("--range", "hs_m=2,x"), "could not convert"),
        (("--range", "hs_m=0,1", "--range", "hs_m=0,2"), "each key once"),
        (("--range", "current_speed_m_s=0,30"), "3 at most"),
        (("--range", "period_ratio=0.1,0.2"), "steepness"),
        (("--grid", "hs_m=1"), "at least current_speed_m_s and current_to_deg"),
        (("--grid", "hs_m=0:1:1"), "the count 2 or more"),
        (("--grid", "hs_m=1", "--cases", 5), "exclude each other"),
        (("--share", "3"), "expected I/N"),
        (("--share", "2/2"), "Shares count from 0"),
        (("--share", "1/2", "--cases", 5), "5 cases make 1 blocks of 16"),
        (("--method", "settle", "--law", "morison"), "an equilibrium knows no law"),
    ],
)
def test_what_cannot_be_simulated_is_refused_in_one_sentence(words, says, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert says in refusal(*words)
    assert not list(tmp_path.iterdir())


def test_the_status_reports_the_first_failures_and_json_all(tmp_path, monkeypatch):
    failures = {case: f"current {case} m/s: lost" for case in range(30)}
    reached = CampaignStatus(
        plan="paper",
        law="loland",
        method="simulate",
        total=100,
        converged=70,
        not_converged=0,
        drowned=0,
        outside_validity=0,
        slack=0,
        diverged=30,
        failures=failures,
        simulated_s=2100.0,
        core_seconds=2.0,
        finished=False,
    )
    monkeypatch.setattr("seacage.campaigns.campaign_status", lambda _: reached)
    result = run("campaign", "status", tmp_path).stdout
    assert "100 of 100, not summed: say `seacage campaign finish`" in result
    assert "2 core-seconds, 1050 simulated seconds in each" in result
    assert "current 19 m/s: lost" in result
    assert "current 20 m/s: lost" not in result
    assert "and 10 more" in result
    whole = json.loads(run("campaign", "status", tmp_path, "--json").stdout)
    assert whole["failures"][29] == {"case": 29, "reason": "current 29 m/s: lost"}
    assert whole["simulated_s_per_core_second"] == 1050.0


def test_a_job_array_is_valid_bash_that_repeats_the_command():
    words = ("my campaign.zarr", "--plan", "paper", "--cases", 100, "--range", "hs_m=0,2")
    script = run("campaign", "slurm", "--tasks", 50, *words).stdout
    assert subprocess.run(["bash", "-n"], input=script, text=True, check=False).returncode == 0
    assert "#SBATCH --array=0-6\n" in script  # 100 cases are 7 blocks
    assert (
        "exec seacage campaign run 'my campaign.zarr' --plan paper --cases 100 --range hs_m=0,2 "
        '--workers 1 --share "$SLURM_ARRAY_TASK_ID/7"\n'
    ) in script
    assert json.loads(run("campaign", "slurm", "--tasks", 50, *words, "--json").stdout) == {
        "script": script
    }


def test_a_job_array_takes_as_many_cores_as_workers_were_requested():
    script = run("campaign", "slurm", "--tasks", 1, "a.zarr", "--workers", 4).stdout
    assert "#SBATCH --cpus-per-task=4\n" in script
    assert script.count("--workers") == 1


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("--colour", 3), 2),
        (("--plan", "papper"), 1),
        (("--share", "0/2"), 2),
        (("--cage", "x"), 1),
    ],
)
def test_a_job_array_that_could_not_run_is_refused_now(words, code):
    result = run("campaign", "slurm", "--tasks", 2, "a.zarr", *words)
    assert result.exit_code == code
    assert "#!/bin/bash" not in result.stdout


CALM = ("--grid", "current_speed_m_s=0.4", "--grid", "current_to_deg=90", "--method", "settle")
SPRINGS = ("--mooring", "springs", "--workers", 1)


def test_one_command_runs_a_campaign_without_each_line_that_is_unlike_the_others(tmp_path: Path):
    words = ("campaign", "run", tmp_path / "parted", *CALM, *SPRINGS, "--parted-lines", "--json")
    stores = json.loads(run(*words).stdout)["stores"]
    assert [(one["parted"], one["answers"]) for one in stores] == [("bridle-1", 1), ("bridle-2", 1)]
    for line in ("bridle-1", "bridle-2"):
        assert read_campaign(tmp_path / "parted" / line).parted == (line,)


def test_two_lines_are_parted_by_name_alone(tmp_path: Path):
    both = ("--without", "bridle-1", "--without", "bridle-2")
    run("campaign", "run", tmp_path / "two", *CALM, *SPRINGS, *both)
    assert read_campaign(tmp_path / "two").parted == ("bridle-1", "bridle-2")
    assert "--parted-lines" in refusal(*CALM, *both, "--parted-lines")


def test_results_of_another_simulator_are_imported_and_read_as_a_campaign(tmp_path: Path):
    folder = write_results(tmp_path / "results", stand_in_campaign(CAGE, stand_in_seas(5)))
    CAGE.write(tmp_path / "mine.toml")
    out, options = tmp_path / "out.zarr", ("--simulator", "Other 1", "--json")
    words = ("campaign", "import", folder, out, "--cage", tmp_path / "mine.toml", *options)
    told = json.loads(run(*words).stdout)
    assert (told["cases"], told["nodes"], told["mesh_of_cage"]) == (5, 81, True)
    assert told["lines"] == list(CAGE.bridle_names)
    status = json.loads(run("campaign", "status", out, "--json").stdout)
    assert (status["law"], status["method"], status["converged"]) == ("Other 1", "import", 5)
    assert run("campaign", "export", out, tmp_path / "out.nc").exit_code == 0
    assert read_campaign(tmp_path / "out.nc").simulator == "Other 1"
    again = run(*words)
    assert again.exit_code == 1
    assert "there is something already" in again.stderr
