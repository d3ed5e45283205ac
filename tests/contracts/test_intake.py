"""Whatever reads a file from outside bounds its kind, its size and its depth."""

import ast
from pathlib import Path

import seacage

ROOT = Path(seacage.__file__).parent
OUR_OWN = {
    # Rows, entries and lines that this service itself wrote into a folder of its own.
    "service/_store": {"json.loads", ".read_bytes", ".read_text", "parquet.read_table"},
    "service/_auth": {"json.loads", ".read_bytes", ".read_text"},
    "service/_small_files.py": {".read_bytes"},
    "service/_publish/_spool.py": {"json.loads", ".read_bytes", ".read_text"},
    "service/_tail.py": {"json.loads"},  # the place in a table
    "service/_ingest/_file_feed.py": {".read_text"},
    "twin/_interval_factors.py": {"json.loads"},  # a column of the store
    "campaigns/_virtual_field/_stretches.py": {"json.loads", ".read_bytes", ".read_text"},
    "studies": {"json.loads", ".read_bytes", ".read_text", "np.load"},
    # What comes with the package.
    "cage/_cage.py": {".read_text"},
    "campaigns/_virtual_field/_truth_parameters.py": {".read_text"},
    "records/_readers/_column_map.py": {".read_text"},
    "service/_cli/_campaign.py": {".read_text"},
    # A file just written, to be sealed.
    "records/_readers/_netcdf.py": {".read_bytes"},
    # Messages of a bounded length, an answer to our own request, a file just written.
    "service/_http/_websocket.py": {"json.loads"},
    "service/_rov/_client.py": {"json.loads"},
    "service/_rov/_ros_messages.py": {".read_bytes"},
    "testing": {"json.loads"},
    # The one reader.
    "conventions/_intake.py": {"json.loads", "tomllib.loads", ".read_text"},
}
READING = {"json.load", "json.loads", "tomllib.load", "tomllib.loads", "np.load"}
METHODS = {"read_bytes", "read_text", "read_table"}


def readings(path: Path) -> set[str]:
    found = set()
    for call in ast.walk(ast.parse(path.read_text())):
        if not isinstance(call, ast.Call) or not isinstance(call.func, ast.Attribute):
            continue
        whose = ast.unparse(call.func.value)
        name = f"{whose}.{call.func.attr}"
        if name in READING:
            found.add(name)
        elif call.func.attr in METHODS:
            parquet = call.func.attr == "read_table"
            found.add("parquet.read_table" if parquet else f".{call.func.attr}")
    return found


def allowed(path: Path) -> set[str]:
    place = path.relative_to(ROOT).as_posix()
    return {one for part, names in OUR_OWN.items() if place.startswith(part) for one in names}


def test_no_file_from_outside_is_read_but_by_the_one_reader():
    wrong = {
        path.relative_to(ROOT).as_posix(): found
        for path in sorted(ROOT.rglob("*.py"))
        if (found := readings(path) - allowed(path))
    }
    assert not wrong, f"read these with read_bytes, parse_json, … of seacage.conventions: {wrong}"


def test_what_may_read_its_own_files_is_still_there():
    assert all((ROOT / place).exists() for place in OUR_OWN)


def test_every_netcdf_file_is_weighed_before_it_is_opened():
    """Each module that has xarray open a path also has the path checked."""
    for path in ROOT.rglob("*.py"):
        text = path.read_text()
        if "xarray.open_dataset(path" in text:
            assert "check_netcdf(" in text, path
