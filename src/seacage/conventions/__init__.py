"""Names, units, axes, errors and codes that every room shares."""

from seacage.conventions._codes import RESULTS, Flag, Origin, Result, gravest, has_answer
from seacage.conventions._constants import GRAVITY, WATER_DENSITY, WATER_VISCOSITY, YEAR
from seacage.conventions._directions import compass, fold_degrees, towards
from seacage.conventions._durations import count_times, duration_text
from seacage.conventions._errors import (
    InputError,
    ModelError,
    NonsenseError,
    RecordError,
    SeacageError,
)
from seacage.conventions._extensions import (
    EXTENSION_GROUPS,
    Extension,
    call_extension,
    extension_names,
    load_extension,
)
from seacage.conventions._intake import (
    TABLE_BYTES,
    TEXT_BYTES,
    check_file,
    parse_json,
    parse_toml,
    read_bytes,
    read_packaged_table,
    read_text,
)
from seacage.conventions._progress import Progress, no_progress
from seacage.conventions._rows import Rows
from seacage.conventions._sentences import SentenceValue, fill_sentence

__all__ = [
    "EXTENSION_GROUPS",
    "GRAVITY",
    "RESULTS",
    "TABLE_BYTES",
    "TEXT_BYTES",
    "WATER_DENSITY",
    "WATER_VISCOSITY",
    "YEAR",
    "Extension",
    "Flag",
    "InputError",
    "ModelError",
    "NonsenseError",
    "Origin",
    "Progress",
    "RecordError",
    "Result",
    "Rows",
    "SeacageError",
    "SentenceValue",
    "call_extension",
    "check_file",
    "compass",
    "count_times",
    "duration_text",
    "extension_names",
    "fill_sentence",
    "fold_degrees",
    "gravest",
    "has_answer",
    "load_extension",
    "no_progress",
    "parse_json",
    "parse_toml",
    "read_bytes",
    "read_packaged_table",
    "read_text",
    "towards",
]
