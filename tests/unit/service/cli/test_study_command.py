"""``seacage study benchmarks``, without running what it runs."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from seacage import studies
from seacage.conventions import InputError
from seacage.service._cli._app import app
from seacage.service._cli._study import _seeds
from seacage.studies import BenchmarkStudy
from seacage.studies._claim import Claim


@pytest.fixture
def asked(monkeypatch):
    """What the study was asked for; it answers with two verdicts at once."""
    given = {}

    def study(out, **options):
        given.update(options, out=out)
        verdicts = (
            Claim(claim="Park: better.", holds=True, finding="It is."),
            Claim(claim="Currin: better.", holds=None, finding="Not run."),
        )
        return BenchmarkStudy(
            report=out / "report.html", scores=out / "scores.json", verdicts=verdicts, summaries=()
        )

    monkeypatch.setattr("seacage.service._logs.begin_logs", lambda _: None)
    monkeypatch.setattr(studies, "benchmark_study", study)
    return given


def test_the_study_is_asked_for_what_the_words_say(asked, tmp_path):
    words = ["study", "benchmarks", "--out", str(tmp_path), "--seeds", "5-6", "--quick", "--json"]
    result = CliRunner().invoke(app, words, catch_exceptions=False)
    assert result.exit_code == 0
    said = json.loads(result.stdout)
    assert said["report"] == str(tmp_path / "report.html")
    assert [one["holds"] for one in said["verdicts"]] == [True, None]
    assert asked["out"] == Path(tmp_path)
    assert list(asked["seeds"]) == [5, 6]
    assert asked["quick"]
    assert asked["peers"] is None


def test_verdicts_are_told_in_words(asked, tmp_path):
    words = ["study", "benchmarks", "--out", str(tmp_path)]
    said = CliRunner().invoke(app, words, catch_exceptions=False).stdout
    assert "holds" in said
    assert "not evaluated" in said
    assert list(asked["seeds"]) == list(range(10))


def test_seeds_are_a_range_or_one():
    assert list(_seeds("0-9")) == list(range(10))
    assert list(_seeds("7")) == [7]
    for written in ("a", "3-", "3-x", "-1", ""):
        with pytest.raises(InputError, match="range of seeds"):
            _seeds(written)
