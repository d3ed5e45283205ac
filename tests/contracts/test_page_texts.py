"""The page's texts know all that the service can put into words about a cage."""

import json
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest

from running_service import NOON, HandClock
from seacage.conventions import read_packaged_table
from seacage.records import Sample
from seacage.service._live._clock import STEP_S, ClockFaults
from seacage.testing import stand_in_twin
from seacage.twin import NO_PARTED_LINES, Answered, FaultDetectorSettings, interval_reason
from seacage.twin._alarms._conditions import LARGEST, MEAN
from seacage.twin._faults import FaultDetector, _detector
from seacage.twin._faults._cusum import Evidence
from seacage.twin._faults._sensor import SensorMonitor
from seacage.twin._lines import _line_loads
from seacage.twin._twin import _fault

WEB = Path(__file__).parents[2] / "web"
SEA = {"current_speed_m_s": 0.5, "current_to_deg": 90.0}
_DUMP = "import texts from '{}'; console.log(JSON.stringify(texts))"
_TRANSLATE = """
globalThis.localStorage = {{ getItem: (key) => (key === "seacage-language" ? "nb" : null) }};
const {{ sentences }} = await import("{}");
console.log(JSON.stringify({}.map(sentences)));
"""


def printed(node: Path, script: str) -> object:
    """What a script of Node's prints as JSON."""
    how = [node, "--input-type=module", "--eval", script]
    return json.loads(subprocess.run(how, capture_output=True, check=True, text=True).stdout)


def texts(node: Path, language: str) -> dict:
    """The page's texts in a language."""
    return printed(node, _DUMP.format((WEB / f"src/texts/{language}.js").as_uri()))


def of_alarms() -> dict:
    """The service's texts of alarms, without their units."""
    tables = read_packaged_table("seacage.twin._alarms", "texts.toml")
    return {kind: {k: v for k, v in one.items() if k != "unit"} for kind, one in tables.items()}


def test_the_page_has_the_services_texts_of_alarms_and_concerns(node: Path) -> None:
    english = texts(node, "en")
    assert english["alarm"] == of_alarms()
    assert english["concern"] == read_packaged_table("seacage.service._live", "concerns.toml")


def reasons() -> Iterator[str]:
    """Why a twin answers nothing, or extrapolates."""
    twin = stand_in_twin()
    buoy = Sample(stream="buoy-1", t=NOON, values=SEA)
    fast = replace(buoy, values={**SEA, "current_speed_m_s": 1.9})
    for samples, hours in (((), 0), ((buoy,), 9), ((fast,), 0)):
        memory = twin.start()
        for sample in samples:
            memory, _ = twin.step(memory, sample, sample.t)
        _, events = twin.step(memory, None, NOON + timedelta(hours=hours))
        (answered,) = (event for event in events if isinstance(event, Answered))
        yield answered.answer.reason[0]
    yield replace(twin.models, inputs=("current", "waves"))._beyond()
    yield from (_fault("buoy-1", key, flag) for key in (*SEA, "hs_m") for flag in (3, 4, 9))


def details() -> Iterator[str]:
    """What the fault detector adds to its alarms."""
    settings = FaultDetectorSettings()
    stuck = SensorMonitor(latest=NOON, since=NOON - timedelta(hours=1), repeats=60)
    for one in FaultDetector(monitors={"depth-1": stuck}).stuck_inputs(settings):
        yield one.detail
    for size in (-1.0, 1.0):
        evidence = {"irregular.depth-1": Evidence(cusum=1.0, size=(size,), covariance=())}
        yield FaultDetector(evidence=evidence)._detail("irregular.depth-1")
    yield FaultDetector()._detail("net.net")
    yield from map(_detector._alternative, ("bridle.bridle-3", "net.net", "irregular.depth-1"))


def clock_faults() -> Iterator[str]:
    """What is wrong with clocks."""
    for streams, step_s in ((3, 0.0), (2, 0.0), (9, 2.0 * STEP_S), (9, -2.0 * STEP_S)):
        clock = HandClock()
        faults = ClockFaults(clock, streams=streams)
        clock.set(NOON + timedelta(seconds=step_s))
        faults.look()
        if not step_s:
            for stream in ("depth-1", "buoy-1"):
                faults.note_refusal(stream, clock.at + timedelta(minutes=90))
        yield from faults.faults().values()


def about_waves() -> Iterator[str]:
    """Why loads in waves are none, or of other waves."""
    yield from (_line_loads.NO_WAVES, _line_loads.NOT_TRAINED)
    yield from (one.format("NORA10") for one in (_line_loads.ANY_WAVES, _line_loads.ANY_TP))


@pytest.mark.parametrize("found", [reasons, details, clock_faults, about_waves])
def test_each_sentence_of_the_service_about_a_cage_has_its_norwegian(found, node: Path) -> None:
    english = [*found()]
    assert all(english)
    assert left_in_english(node, english) == []


def test_sentences_that_stand_alone_have_their_norwegian(node: Path) -> None:
    alone = [LARGEST, MEAN, NO_PARTED_LINES, interval_reason(known=False)]
    assert left_in_english(node, [*alone, " ".join(alone)]) == []


def left_in_english(node: Path, english: list[str]) -> list[str]:
    """The sentences that the page would show as they are, or half of them."""
    module = (WEB / "src/service-words.js").as_uri()
    shown = printed(node, _TRANSLATE.format(module, json.dumps(english)))
    words = (" the ", " is ", "undefined", "No ")
    return [one for one in shown if one in english or any(word in one for word in words)]
