"""Whole shapes by peers: proper orthogonal modes with an interpolator, and a graph network.

Usage: shapes.py METHOD IN.npz OUT.npz, METHOD one of `ezyrb-rbf`, `ezyrb-gpr`, `pyg-gcn`.

IN has `x_train` (n, features), `y_train` (n, nodes, 3) [m], `x_test` (rows, features), and for
the graph network `edges` (edge, 2); optional are `modes` (40), `epochs` (300), `hidden` (64),
`layers` (3) and `seed` (0). OUT has `mean` (rows, nodes, 3) [m], and OUT.json the processor's
seconds to fit, to predict all rows and to predict one.

EZyRB: as many modes as asked for; radial basis functions with its default thin-plate spline, or
scikit-learn's Gaussian process with a kernel given, since its own default has a fixed length and
learns nothing. PyTorch Geometric: its graph convolution (Kipf & Welling) with Swish between, the
features copied to every node beside the node's place at rest (the mean training shape), and
displacements in standard deviations as targets; Adam, the tenth part held back to stop early.
"""

import json
import sys
import time
import warnings
from importlib import import_module
from itertools import pairwise
from pathlib import Path

import numpy as np

# The peers live in an environment of their own.
# pyright: reportMissingImports=false, reportArgumentType=false


def ezyrb(given, approximation):
    from ezyrb import POD, Database, ReducedOrderModel

    x, y = given["x_train"], given["y_train"]
    centre, spread = x.mean(axis=0), x.std(axis=0)
    rest = y.mean(axis=0)
    modes = POD("svd", rank=int(given.get("modes", 40)))
    database = Database((x - centre) / spread, (y - rest).reshape(len(y), -1))
    model = ReducedOrderModel(database, modes, approximation).fit()

    def predict(x):
        answer = model.predict((x - centre) / spread)
        return rest + np.asarray(getattr(answer, "snapshots_matrix", answer)).reshape(
            -1, *rest.shape
        )

    return predict


def ezyrb_rbf(given):
    from ezyrb import RBF

    return ezyrb(given, RBF())


def ezyrb_gpr(given):
    from ezyrb import GPR
    from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel

    width = given["x_train"].shape[1]
    kernel = ConstantKernel(1.0) * Matern(np.ones(width), nu=2.5) + WhiteKernel(1e-4, (1e-9, 1.0))
    return ezyrb(given, GPR(kern=kernel, optimization_restart=3))


def pyg_gcn(given):
    import torch
    from torch_geometric.nn import GCNConv

    torch.set_num_threads(1)
    torch.manual_seed(int(given.get("seed", 0)))
    x, y = given["x_train"], given["y_train"]
    centre, spread, rest = x.mean(axis=0), x.std(axis=0), y.mean(axis=0)
    scale = (y - rest).std()
    place = torch.tensor((rest - rest.mean(axis=0)) / rest.std(), dtype=torch.float32)
    both = np.vstack([given["edges"], given["edges"][:, ::-1]]).T
    edges = torch.tensor(np.unique(both, axis=1), dtype=torch.long)
    hidden, layers = int(given.get("hidden", 64)), int(given.get("layers", 3))

    class Network(torch.nn.Module):
        def __init__(self):
            super().__init__()
            widths = [x.shape[1] + 3] + [hidden] * (layers - 1) + [3]
            self.steps = torch.nn.ModuleList(
                GCNConv(a, b, node_dim=-2, cached=True) for a, b in pairwise(widths)
            )

        def forward(self, features):
            rows, nodes = len(features), len(place)
            copied = features[:, None, :].expand(rows, nodes, -1)
            state = torch.cat([copied, place.expand(rows, nodes, 3)], dim=-1)
            for index, step in enumerate(self.steps):
                state = step(state, edges)
                if index + 1 < layers:
                    state = torch.nn.functional.silu(state)
            return state

    network = Network()
    features = torch.tensor((x - centre) / spread, dtype=torch.float32)
    targets = torch.tensor((y - rest) / scale, dtype=torch.float32)
    _train(network, features, targets, int(given.get("epochs", 300)))

    def predict(x):
        with torch.no_grad():
            answer = network(torch.tensor((x - centre) / spread, dtype=torch.float32))
        return rest + scale * answer.double().numpy()

    return predict


def _train(network, features, targets, epochs, *, batch=32, patience=30):
    """Adam until the tenth part held back has not improved for a while; the best state stays."""
    import torch

    held = torch.arange(len(features)) % 10 == 9
    teach = torch.nonzero(~held)[:, 0]
    optimizer = torch.optim.Adam(network.parameters(), lr=5e-3)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, epochs)
    best, state, waited = float("inf"), network.state_dict(), 0
    for epoch in range(epochs):
        for rows in teach[torch.randperm(len(teach))].split(batch):
            optimizer.zero_grad()
            torch.nn.functional.mse_loss(network(features[rows]), targets[rows]).backward()
            optimizer.step()
        schedule.step()
        with torch.no_grad():
            loss = float(torch.nn.functional.mse_loss(network(features[held]), targets[held]))
        waited += 1
        if loss < best:
            best, waited = loss, 0
            state = {name: value.clone() for name, value in network.state_dict().items()}
        print(f"epoch {epoch + 1}/{epochs}, held back {loss:.4g}", file=sys.stderr)
        if waited >= patience:
            break
    network.load_state_dict(state)


METHODS = {"ezyrb-rbf": ezyrb_rbf, "ezyrb-gpr": ezyrb_gpr, "pyg-gcn": pyg_gcn}
LOADED = {"ezyrb-rbf": "ezyrb", "ezyrb-gpr": "ezyrb", "pyg-gcn": "torch_geometric.nn"}
"""Libraries that are imported before anything is timed."""


def seconds(work):
    began = time.process_time()
    answer = work()
    return time.process_time() - began, answer


def main(method, source, target):
    warnings.simplefilter("ignore")
    with np.load(source) as file:
        given = dict(file)
    import_module(LOADED[method])
    fit_s, predict = seconds(lambda: METHODS[method](given))
    x = given["x_test"]
    predict(x[:1])
    predict_s, mean = seconds(lambda: predict(x))
    ticks = [seconds(lambda row=row: predict(row))[0] for row in x[:20, None, :]]
    np.savez(target, mean=mean)
    done = {"fit_s": fit_s, "predict_s": predict_s, "tick_s": sorted(ticks)[len(ticks) // 2]}
    Path(f"{target}.json").write_text(json.dumps(done), encoding="utf-8")
    print(json.dumps(done))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
