"""Say which peers this environment can import, one line each; none of them has to."""

from importlib import import_module
from importlib.metadata import version

PEERS = {
    "emukit": "emukit.multi_fidelity.models.non_linear_multi_fidelity_model",
    "gpy": "GPy",
    "smt": "smt.applications.mfk",
    "botorch": "botorch.models",
    "scikit-learn": "sklearn.gaussian_process",
    "ezyrb": "ezyrb",
    "torch-geometric": "torch_geometric.nn",
}

for package, module in PEERS.items():
    try:
        import_module(module)
        print(f"  {package:<16} {version(package)}")
    except Exception as error:  # noqa: BLE001 - whatever it is, the report will say it
        print(f"  {package:<16} cannot be used: {type(error).__name__}: {error}")
