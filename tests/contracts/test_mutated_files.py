"""Broken files: a clear error or a flagged record, never a traceback or a silent wrong value."""

from collections import Counter

import numpy as np
import pytest

from broken_files import MAPS, MUTATIONS, TABLES, WHOLE, cut, flipped, stored_streams
from seacage.conventions import Flag, SeacageError
from seacage.records import read_record

BLOCK = 500


def wrong_silently(good, record):
    """Values of a record that the good one contradicts and no flag gives away."""
    found = []
    for key, values in record.values.items():
        if key not in good.values:
            found.append((key, "a quantity that the file does not have"))
            continue
        at = np.searchsorted(good.time, record.time)
        known = (at < len(good)) & (good.time[np.minimum(at, len(good) - 1)] == record.time)
        expected = np.where(known, good.values[key][np.minimum(at, len(good) - 1)], np.nan)
        same = known & ((values == expected) | (np.isnan(values) & np.isnan(expected)))
        silent = ~same & (record.flags[key] < Flag.SUSPECT)
        found += [(key, str(record.time[row]), values[row]) for row in np.flatnonzero(silent)]
    return found


def outcome(good, path, columns, *, whole=False):
    """How a broken file was taken; fails where it was taken for what it is not."""
    try:
        record = read_record(path, columns=columns)
    except SeacageError as error:
        message = str(error)
        assert path.name in message, message
        assert "\n" not in message.strip(), message
        return "refused"
    wrong = wrong_silently(good, record)
    flagged = any(np.any(flags >= Flag.SUSPECT) for flags in record.flags.values())
    assert not wrong or (whole and flagged), wrong[:3]
    return "flagged" if flagged else "as it was"


def broken_tables(folder, seeds):
    good = {}
    for name, content in TABLES.items():
        (folder / name).write_bytes(content)
        good[name] = read_record(folder / name, columns=MAPS.get(name))
    names = tuple(TABLES)
    tally = Counter()
    for seed in seeds:
        random = np.random.default_rng(seed)
        name = names[random.integers(len(names))]
        mutation = MUTATIONS[random.integers(len(MUTATIONS))]
        content = mutation(random, TABLES[name])
        path = folder / name
        path.write_bytes(content)
        try:
            output = outcome(good[name], path, MAPS.get(name), whole=mutation in WHOLE)
        except Exception as error:
            error.add_note(f"seed {seed}: {mutation.__name__} of {name}:\n{content[:600]!r}")
            raise
        tally[mutation.__name__, output] += 1
    return tally


def test_hundreds_of_broken_tables_are_refused_or_flagged(tmp_path):
    tally = broken_tables(tmp_path, range(BLOCK))
    assert {name for name, _ in tally} == {mutation.__name__ for mutation in MUTATIONS}
    assert {output for _, output in tally} == {"refused", "flagged", "as it was"}


@pytest.mark.slow
@pytest.mark.parametrize("block", range(1, 20))
def test_thousands_of_broken_tables_are_refused_or_flagged(tmp_path, block):
    tally = broken_tables(tmp_path, range(block * BLOCK, (block + 1) * BLOCK))
    assert sum(tally.values()) == BLOCK


def broken_streams(folder, seeds):
    pytest.importorskip("xarray")
    tally = Counter()
    stored = stored_streams(folder)
    good = {name: read_record(folder / name, columns=how) for name, (_, how) in stored.items()}
    for seed in seeds:
        random = np.random.default_rng(seed)
        name = ("own.nc", "foreign.nc")[random.integers(2)]
        content, how = stored[name]
        # A foreign file has no checksum, so its bits may flip unseen; it is only cut.
        broken = flipped(random, content) if name == "own.nc" else cut(random, content)
        (folder / name).write_bytes(broken)
        try:
            record = read_record(folder / name, columns=how)
        except SeacageError:
            tally[name, "refused"] += 1
            continue
        except Exception as error:
            error.add_note(f"seed {seed}: {name}")
            raise
        assert not wrong_silently(good[name], record), seed
        tally[name, "read"] += 1
    return tally


@pytest.mark.filterwarnings("ignore")  # the libraries warn of what they are about to refuse
def test_a_damaged_stream_is_refused_or_read_rightly(tmp_path):
    assert broken_streams(tmp_path, range(60))["own.nc", "refused"] > 0


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("block", range(1, 11))
def test_many_damaged_streams_are_refused_or_read_rightly(tmp_path, block):
    broken_streams(tmp_path, range(block * 100, (block + 1) * 100))
