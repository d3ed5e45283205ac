"""Simulate the demonstration's virtual field in waves again, and write the file that keeps it.

    python tools/make_demonstration_field.py OUT [--workers 2]     some 30 core-minutes

OUT keeps finished hours, so a stopped command goes on. Prints the file's SHA-256, which belongs
into ``seacage/studies/_demonstration_field.py``: on a processor with AVX-512 the same bits come
out as long as physics and hidden parameters stay.
"""

import argparse
import hashlib
import json
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import (
    Timetable,
    TruthParameters,
    generated_current,
    generated_waves,
    virtual_field,
)
from seacage.records import FieldRecord
from seacage.studies import _demonstration_field as kept

# Shackles live for so many hours from these shares of the record on: the later ones at its show
SHACKLES = ((0.1, 12.0), (0.5, 24.0))

STRETCH_S = 3600.0  # the same on every kernel, so that its lanes do not decide on the numbers

# Of the files in the zip, so that its bytes depend on their contents alone
STAMP = 1980, 1, 1, 0, 0, 0


def main() -> None:
    """Simulate, write and compare."""
    options = argparse.ArgumentParser(description="Make the demonstration's virtual field again.")
    options.add_argument("out", type=Path)
    options.add_argument("--workers", type=int)
    given = options.parse_args()
    made = pack(simulated(given.out, given.workers))
    print(f"{kept.FILE}: {kept.FILE.stat().st_size:,} bytes, {made}")
    print("as kept" if made == kept.SHA256 else f"not as kept, which is {kept.SHA256}")


def simulated(folder: Path, workers: int | None) -> FieldRecord:
    """The field, with the hidden parameters that ship but for the hours of the shackles."""
    hidden = TruthParameters.read()
    made = virtual_field(
        Cage.named("ace"),
        generated_current(kept.SEED, start=kept.START, days=kept.DAYS),
        hidden=replace(hidden, shackle=replace(hidden.shackle, windows=SHACKLES)),
        seed=kept.SEED,
        waves=generated_waves(kept.SEED, start=kept.START, days=kept.DAYS + 1.0),
        timetable=Timetable(stretch=STRETCH_S),
        kept=folder / "stretches",
        workers=workers,
        progress=lambda stage, done, total: print(f"{stage}: {done} of {total}", flush=True),
    )
    return made.record


def pack(record: FieldRecord) -> str:
    """Write a field to ``kept.FILE``, rounded to ``kept.STEPS``, and return the file's SHA-256."""
    streams = (record.buoy, *record.sensors.values())
    description = {
        "cage": record.cage,
        "buoy": record.buoy.stream,
        "hidden_sha256": record.hidden_sha256,
        "notes": record.notes,
        "streams": {one.stream: list(one.values) for one in streams},
    }
    with zipfile.ZipFile(kept.FILE, "w") as packed:

        def put(name: str, content: bytes) -> None:
            packed.writestr(zipfile.ZipInfo(name, STAMP), content, zipfile.ZIP_LZMA)

        put(kept.DESCRIPTION, json.dumps(description, indent=1).encode())
        for one in streams:
            milliseconds = one.time.astype("datetime64[ms]").astype(np.int64)
            put(f"{one.stream}/time", np.diff(milliseconds, prepend=0).astype("<i8").tobytes())
            for key, values in one.values.items():
                steps = np.round(values / kept.STEPS[key])
                whole = np.nan_to_num(steps, nan=kept.NONE).astype("<i4")
                # Byte by byte, as the upper ones hardly change.
                put(f"{one.stream}/{key}", whole.view(np.uint8).reshape(-1, 4).T.tobytes())
    return hashlib.sha256(kept.FILE.read_bytes()).hexdigest()


if __name__ == "__main__":
    main()
