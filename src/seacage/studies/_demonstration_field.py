"""The demonstration's virtual field in waves, simulated once and kept as a file.

``tools/make_demonstration_field.py`` makes the file.
"""

import hashlib
import json
import zipfile
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from seacage.conventions import Origin, RecordError
from seacage.records import FieldRecord, Record, check_record

FILE = Path(__file__).with_name("demonstration_field.zip")
# Of the file, as it was made on a kernel for x86-64-v4; on another its numbers differ by 0.1 %
SHA256 = "f6e323cbc8b51637b44c9c356fed260c7c5813290bccdd00395909b20d8af50d"

# The seed is of weather that is rough and calm in the training days and after them
START, DAYS, TRAINING_DAYS, SEED = datetime(2020, 1, 18, tzinfo=UTC), 4.0, 2, 89

# That readings are kept in, by key: far below the sensors' noise
STEPS = {
    "tension_kn": 0.01,
    "depth_m": 0.001,
    "current_speed_m_s": 0.001,
    "current_to_deg": 0.1,
    "hs_m": 0.01,
    "tp_s": 0.01,
    "wave_from_deg": 0.1,
}

NONE = np.iinfo(np.int32).min  # in place of a reading that is not a number
DESCRIPTION = "field.json"


def read_demonstration_field() -> FieldRecord:
    """Read the kept field.

    Raises RecordError: the file is another one than was shipped.
    """
    if not FILE.exists() or hashlib.sha256(FILE.read_bytes()).hexdigest() != SHA256:
        raise RecordError(
            f"{FILE.name}: the demonstration's field is missing or damaged: its SHA-256 is not "
            "that of the file that seacage ships. Install seacage anew."
        )
    with zipfile.ZipFile(FILE) as packed:
        description = json.loads(packed.read(DESCRIPTION))
        streams = {
            name: _read_stream(packed, name, keys) for name, keys in description["streams"].items()
        }
    return FieldRecord(
        cage=description["cage"],
        buoy=streams.pop(description["buoy"]),
        sensors=streams,
        origin=Origin.VIRTUAL_FIELD,
        hidden_sha256=description["hidden_sha256"],
        notes=tuple(description["notes"]),
    )


def _read_stream(packed: zipfile.ZipFile, stream: str, keys: Sequence[str]) -> Record:
    time = np.frombuffer(packed.read(f"{stream}/time"), dtype="<i8").cumsum()
    values = dict[str, np.ndarray]()
    for key in keys:
        planes = np.frombuffer(packed.read(f"{stream}/{key}"), dtype=np.uint8).reshape(4, -1)
        steps = np.ascontiguousarray(planes.T).view("<i4")[:, 0]
        values[key] = np.where(steps == NONE, np.nan, steps * STEPS[key])
    return check_record(
        Record(
            stream=stream,
            time=time.astype("datetime64[ms]"),
            values=values,
            origin=Origin.VIRTUAL_FIELD,
        )
    )
