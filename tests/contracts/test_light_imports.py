"""A barge computer loads the service and the twin alone."""

import subprocess
import sys

HEAVY = {"dask", "h5py", "jax", "matplotlib", "pandas", "pyarrow", "xarray", "zarr"}


def test_the_service_and_the_twin_load_nothing_that_a_barge_lacks() -> None:
    script = "import sys, seacage.service, seacage.twin; print(*sys.modules)"
    result = subprocess.run(
        [sys.executable, "-c", script], check=True, capture_output=True, text=True
    )
    assert not HEAVY & set(result.stdout.split())
