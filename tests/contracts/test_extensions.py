"""What other packages add: the suites find every broken promise, and the doors refuse it."""

import re
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from extensions import install
from seacage.cage import Cage
from seacage.campaigns import Plan, Simulator, run_campaign
from seacage.campaigns._cases import software_version
from seacage.conventions import (
    Flag,
    InputError,
    Origin,
    RecordError,
    extension_names,
    load_extension,
)
from seacage.dynamics import ScreenLaw, loland, settle
from seacage.ocean import SeaState
from seacage.records import Reader, Record, instant, read_record
from seacage.surrogates import GaussianProcess
from seacage.testing import check_reader, check_screen_law, check_surrogate

SEA = SeaState(current_speed=0.3, current_to=0.0)
CAGE = Cage.named("ace").altered(mesh={"spokes": 8})


def facing_loland(solidity):
    drag, _ = loland(solidity, np.ones_like(solidity))
    _, lift = loland(solidity, np.full_like(solidity, np.sqrt(0.5)))
    return drag, lift


LOLAND = ScreenLaw(title="Løland (1991)", coefficients=facing_loland, skin_friction=0.04)


# Screen laws


def test_a_law_of_ours_keeps_its_promises_as_one_of_somebody_elses():
    check_screen_law(LOLAND)


def test_a_law_of_ours_moves_the_cage_alike_as_one_of_somebody_elses():
    ours, theirs = (settle(CAGE, SEA, law=law) for law in ("loland", LOLAND))
    np.testing.assert_allclose(theirs.node_position, ours.node_position, atol=1e-6)
    np.testing.assert_allclose(theirs.net_force, ours.net_force, rtol=1e-9)


def twice(drag):
    """A law whose drag of a facing panel is given by the solidity."""
    return lambda s: (drag(s), 0.0 * s)


def neighbours(s):
    return s + 0.1 * np.mean(s), 0.0 * s


def writes(s):
    s *= 0.5
    return s, 0.0 * s


BROKEN_LAWS = {
    "falls as the solidity rises": ScreenLaw(title="a", coefficients=twice(lambda s: 1.0 - s)),
    "less than the C_D along": ScreenLaw(title="a", coefficients=twice(np.copy), skin_friction=0.5),
    "C_D falls below 0": ScreenLaw(title="a", coefficients=twice(np.copy), third=2.0),
    "C_L is larger": ScreenLaw(title="a", coefficients=lambda s: (s, 2.0 * s)),
    "not finite": ScreenLaw(title="a", coefficients=twice(lambda s: s / (s - 0.7))),
    "not one each": ScreenLaw(title="a", coefficients=lambda s: (s.sum(keepdims=True),) * 2),
    "depends on neighbours": ScreenLaw(title="a", coefficients=neighbours),
    "writes into": ScreenLaw(title="a", coefficients=writes),
}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("promise", BROKEN_LAWS)
def test_a_law_that_breaks_a_promise_is_named_by_it(promise):
    with pytest.raises(AssertionError, match=promise):
        check_screen_law(BROKEN_LAWS[promise])


@pytest.mark.parametrize(
    ("law", "says"),
    [
        (ScreenLaw(title="A (1999)", coefficients=twice(lambda s: -s)), "drag down to -0"),
        (ScreenLaw(title="A (1999)", coefficients=twice(lambda s: s * np.nan)), "must be finite"),
        (replace(LOLAND, title="A (1999)", skin_friction=-1.0), "drag down to -1"),
        (replace(LOLAND, title="A (1999)", third=np.inf), "must be finite"),
        (ScreenLaw(title="A (1999)", coefficients=lambda s: s["no"]), "fails (IndexError: "),
    ],
)
def test_a_law_without_sound_numbers_settles_nothing(law, says):
    with pytest.raises(InputError) as refused:
        settle(CAGE, SEA, law=law)
    message = str(refused.value)
    assert "screen law 'A (1999)'" in message.replace("S", "s", 1)
    assert says in message
    assert message.endswith(".")
    assert "\n" not in message


# Readers

FIRST = datetime(2026, 1, 5, 9, tzinfo=UTC)
TEXT = "".join(f"{60 * row} {12.25 + row}\n" for row in range(5))


def read_rows(path, stream, *, scale=1.0, zone=UTC, doubt=True, tidy=True):
    text = path.read_text("latin-1")
    try:
        rows = [[float(cell) for cell in line.split()] for line in text.splitlines()]
        if len(rows[-1]) == 1 and not text.endswith("\n"):
            rows.pop()
        seconds, depth = np.array(rows).T
    except (ValueError, IndexError) as error:
        if not tidy:
            raise
        raise RecordError(f"{path}: no rows of two numbers. Export it again.") from error
    flags = np.full(len(depth), Flag.NOT_EVALUATED)
    if doubt and not text.endswith("\n"):
        flags[-1] = Flag.SUSPECT
    start = instant(FIRST.replace(tzinfo=zone).astimezone(UTC))
    return Record(
        stream=stream,
        time=start + (seconds * 1e6).astype("timedelta64[us]"),
        values={"depth_m": scale * depth},
        flags={"depth_m": flags},
        origin=Origin.MEASURED,
    )


def check(tmp_path, **how):
    path = tmp_path / "logger.lgr"
    path.write_text(TEXT)
    values = {"depth_m": 12.25}
    reader = Reader(read=lambda path, stream: read_rows(path, stream, **how), endings=(".lgr",))
    check_reader(reader, path, first=FIRST, values=values)


def test_a_sound_reader_keeps_its_promises(tmp_path):
    check(tmp_path)


@pytest.mark.parametrize(
    ("how", "promise"),
    [
        ({"scale": 100.0}, "first depth_m"),
        ({"zone": None}, "another time zone"),
        ({"doubt": False}, "flag the last row"),
    ],
)
def test_a_reader_that_breaks_a_promise_is_named_by_it(tmp_path, how, promise, monkeypatch):
    monkeypatch.setenv("TZ", "UTC")  # where the programmer's own clock hides it
    with pytest.raises(AssertionError, match=promise):
        check(tmp_path, **how)


def test_a_reader_that_fails_on_an_empty_file_breaks_its_promise(tmp_path):
    with pytest.raises((ValueError, IndexError)):
        check(tmp_path, tidy=False)


def test_a_reader_that_takes_everything_breaks_its_promise(tmp_path):
    path = tmp_path / "logger.lgr"
    path.write_text(TEXT)
    greedy = Reader(read=read_rows, recognises=lambda _: True)
    with pytest.raises(AssertionError, match="for its own format"):
        check_reader(greedy, path, first=FIRST, values={"depth_m": 12.25})


# Surrogates


class Compared:
    """A process that is only compared, and has no saved form."""

    def __init__(self, x, y, seed):
        self.fitted = GaussianProcess(restarts=0).fit(x, y, seed=seed)

    def predict(self, x, *, noisy=False):
        return self.fitted.predict(x, noisy=noisy)


def test_a_surrogate_that_is_only_compared_need_not_be_saved():
    check_surrogate(Compared, saves=False)
    with pytest.raises(AssertionError, match="no to_arrays"):
        check_surrogate(Compared)


# Packages

MODULE = """
from seacage.dynamics import ScreenLaw
from seacage.records import Reader
GOOD = ScreenLaw(title="mine", coefficients=lambda s: (s, 0.0 * s))
FAILS = Reader(read=lambda path, stream: 1 / 0, endings=(".fails",))
EMPTY = Reader(read=lambda path, stream: None, endings=(".empty",))
ONE = Reader(read=lambda path, stream: None, recognises=lambda start: start.startswith(b"TWO"))
TWO = Reader(read=lambda path, stream: None, recognises=lambda start: start.startswith(b"TWO"))
"""


@pytest.fixture
def packages(tmp_path, monkeypatch):
    """Two packages with names of their own for each test, as modules stay loaded."""
    places = {
        "tidelab": {
            "seacage.screen_laws": {
                "tl-good": "tidelab:GOOD",
                "tl-shared": "tidelab:GOOD",
                "tl-none": "tidelab:NONE",
                "tl-reader": "tidelab:FAILS",
                "tl-no-module": "tidelab_absent:LAW",
                "loland": "tidelab:GOOD",
            },
            "seacage.readers": {n: f"tidelab:{n}" for n in ("FAILS", "EMPTY", "ONE", "TWO")},
        },
        "wavelab": {"seacage.screen_laws": {"tl-shared": "wavelab:GOOD"}},
    }
    for name, groups in places.items():
        install(tmp_path, name, "2.5", groups, MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    for known in (extension_names, load_extension):
        known.cache_clear()
    yield tmp_path
    for known in (extension_names, load_extension):
        known.cache_clear()


def test_an_installed_law_settles_by_its_name(packages):
    by_name = settle(CAGE, SEA, law="tl-good")
    assert by_name.result == 0
    same = settle(CAGE, SEA, law=load_extension("screen_laws", "tl-good", ScreenLaw).value)
    np.testing.assert_array_equal(by_name.node_position, same.node_position)


def test_a_name_of_ours_stays_ours(packages):
    ours = settle(CAGE, SEA, law="loland")
    np.testing.assert_allclose(ours.net_force, settle(CAGE, SEA, law=LOLAND).net_force, rtol=1e-9)


@pytest.mark.parametrize(
    ("law", "says"),
    [
        ("tl-absent", "No screen law 'tl-absent'; there are: aarsnes, loland, kristiansen-"),
        ("tl-shared", "'tl-shared' of tidelab 2.5 and wavelab 2.5. Uninstall"),
        ("tl-none", "'tl-none' of tidelab 2.5 fails (AttributeError"),
        ("tl-no-module", "'tl-no-module' of tidelab 2.5 fails (ModuleNotFoundError"),
        ("tl-reader", "'tl-reader' of tidelab 2.5 is of type Reader, where a ScreenLaw is needed"),
    ],
)
def test_a_name_without_a_law_is_refused_in_one_sentence(packages, law, says):
    with pytest.raises(InputError, match=re.escape(says)) as refused:
        settle(CAGE, SEA, law=law)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.fails", "x", "'FAILS' of tidelab 2.5, given .*a.fails, fails .ZeroDivisionError"),
        ("a.empty", "x", "'EMPTY' of tidelab 2.5 finds no rows in it"),
        ("a.csv", "TWO\n", "'ONE' of tidelab 2.5 and the reader 'TWO' of tidelab 2.5 both take"),
        ("a.csv", "x\n1\n", "no shipped column map"),
        ("absent.fails", None, "cannot be read"),
    ],
)
def test_a_file_that_a_reader_cannot_read_is_refused_in_one_sentence(packages, name, text, says):
    path: Path = packages / name
    if text is not None:
        path.write_text(text)
    with pytest.raises(InputError, match=says) as refused:
        read_record(path)
    assert "\n" not in str(refused.value)


def test_a_campaign_goes_on_with_the_same_version_of_a_law_alone(packages):
    plan, store = Plan.sample(2, 1), packages / "campaign"
    how = {"law": "tl-good", "method": "settle", "workers": 1}
    first = run_campaign(CAGE, plan, store, **how)
    assert first.law == "tl-good (tidelab 2.5)"
    assert run_campaign(CAGE, plan, store, **how).sha256 == first.sha256
    assert software_version("tl-good").endswith(", law tl-good (tidelab 2.5)")
    assert ", law" not in software_version("loland")
    about = packages / "tidelab-2.5.dist-info/METADATA"
    about.write_text(about.read_text().replace("2.5", "2.6"))
    load_extension.cache_clear()
    with pytest.raises(InputError, match="a campaign with another load law"):
        run_campaign(CAGE, plan, store, **how)
    with pytest.raises(InputError, match="No screen law 'tl-absent'"):
        Simulator(law="tl-absent")
