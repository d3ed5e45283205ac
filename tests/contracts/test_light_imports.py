"""A barge computer loads the service and the twin alone."""

import subprocess
import sys

HEAVY = {"dask", "h5py", "jax", "matplotlib", "pandas", "pyarrow", "xarray", "zarr"}


def loaded_by(statement: str) -> set[str]:
    """Names of the modules that a fresh Python has after an import."""
    script = f"import sys; {statement}; print(*sys.modules)"
    result = subprocess.run(
        [sys.executable, "-c", script], check=True, capture_output=True, text=True
    )
    return set(result.stdout.split())


def test_the_service_and_the_twin_load_nothing_that_a_barge_lacks() -> None:
    assert not HEAVY & loaded_by("import seacage.service, seacage.twin")


def test_settings_are_read_without_the_twin() -> None:
    assert not (HEAVY | {"scipy", "seacage.twin"}) & loaded_by("import seacage.service._settings")
