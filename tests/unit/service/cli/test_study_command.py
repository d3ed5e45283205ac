"""``seacage study benchmarks``, without running what it runs."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from seacage import studies
from seacage.conventions import InputError
from seacage.service._cli._app import app
from seacage.service._cli._study import _numbers
from seacage.studies import BenchmarkStudy
from seacage.studies._text import Claim


@pytest.fixture
def study_options(monkeypatch):
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


def test_the_study_is_run_as_the_words_say(study_options, tmp_path):
    words = ["study", "benchmarks", "--out", str(tmp_path), "--seeds", "5-6", "--quick", "--json"]
    result = CliRunner().invoke(app, words, catch_exceptions=False)
    assert result.exit_code == 0
    answer = json.loads(result.stdout)
    assert answer["report"] == str(tmp_path / "report.html")
    assert [one["holds"] for one in answer["verdicts"]] == [True, None]
    assert study_options["out"] == Path(tmp_path)
    assert list(study_options["seeds"]) == [5, 6]
    assert study_options["quick"]
    assert study_options["peers"] is None


def test_verdicts_are_put_in_words(study_options, tmp_path):
    words = ["study", "benchmarks", "--out", str(tmp_path)]
    result = CliRunner().invoke(app, words, catch_exceptions=False).stdout
    assert "holds" in result
    assert "not evaluated" in result
    assert list(study_options["seeds"]) == list(range(10))


def test_seeds_are_a_range_or_one():
    assert list(_numbers("seeds", "0-9")) == list(range(10))
    assert list(_numbers("seeds", "7")) == [7]
    for written in ("a", "3-", "3-x", "-1", ""):
        with pytest.raises(InputError, match="is not a range"):
            _numbers("seeds", written)
