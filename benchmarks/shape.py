"""The whole shape: the paper's model, its network, ours and a peer, on the same campaign.

Without `--campaign STORE` it settles a small one. `--again 16` simulates so many of the held-out
cases once more with other waves: what half an hour's mean owes to the waves it happened to meet
is the error that no model can go below. `--peers .venv-peers` asks EZyRB too (`make bench-peers`).
Errors are in metres over all nodes of the last tenth of the cases; times are the processor's.
"""

import argparse
import json
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np
from _timing import ONCE

from seacage.cage import Cage
from seacage.campaigns import Plan, run_campaign
from seacage.conventions import SeacageError
from seacage.records import CampaignRecord, read_campaign
from seacage.surrogates import (
    GCN,
    OverTime,
    PcaGP,
    Prediction,
    ShapeGP,
    Symmetry,
    coverage,
    metocean_features,
)

PEERS = Path(__file__).parent / "peers" / "shapes.py"


def main() -> None:
    """Compare them all and print one table."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--once", action="store_true")
    arguments.add_argument("--campaign", type=Path)
    arguments.add_argument("--again", type=int, default=0)
    arguments.add_argument("--peers", type=Path)
    options = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        campaign = _campaign(options.campaign, scratch)
        good = np.flatnonzero(campaign.converged)
        x, y = _features(campaign)[good], campaign.node_position[good]
        held = max(len(good) // 10, 2)
        print(f"{len(good) - held} cases teach, {held} judge; {campaign.law}, computed")
        if options.again:
            _print_floor(campaign, good[-held:][: options.again], scratch)
        race = Race(x, y, held)
        _ours(race, campaign, good)
        if options.peers:
            _peers(race, options.peers, scratch)


def _campaign(store: Path | None, scratch: Path) -> CampaignRecord:
    if store is not None:
        return read_campaign(store)
    plan = Plan.named("paper", 0, 40 if ONCE else 250)
    return run_campaign(Cage.named("ace"), plan, scratch / "store", method="settle", workers=1)


def _features(campaign: CampaignRecord) -> np.ndarray:
    seas = campaign.seas
    return metocean_features(
        np.array([sea.current_velocity for sea in seas]),
        hs=np.array([sea.hs for sea in seas]),
        wave_direction=np.array([sea.wave_direction for sea in seas]),
        tp=np.array([sea.peak_period for sea in seas]),
    )


class Race:
    """One table: each model learns from the same cases and is judged by the same others."""

    def __init__(self, x: np.ndarray, y: np.ndarray, held: int) -> None:
        self.x, self.y, self.held = x, y, held
        self.first: float | None = None
        print(
            f"{'':<44}{'MAE m':>9}{'first/':>8}{'x':>8}{'y':>8}{'z':>8}{'p99 m':>8}{'worst':>8}"
            f"{'95 %':>7}{'node':>7}{'fit s':>8}{'ms':>7}"
        )

    def run(self, name: str, fit: Callable, columns: int) -> None:
        """Fit, judge and print one of ours."""
        x = self.x[:, :columns]
        began = time.process_time()
        fitted = fit(x[: -self.held], self.y[: -self.held])
        fit_s = time.process_time() - began
        answer = fitted.predict(x[-self.held :], noisy=True)
        ticks = [_spent(lambda row=row: fitted.predict(row)) for row in x[-50:, None, :]]
        self.print_line(name, answer, fit_s=fit_s, tick_s=float(np.median(ticks)))

    def print_line(self, name: str, answer: Prediction, *, fit_s: float, tick_s: float) -> None:
        """Print one line; the first model's error is what all others are held against."""
        truth = self.y[-self.held :]
        missed = np.abs(answer.mean - truth)
        distance = np.linalg.norm(answer.mean - truth, axis=2)
        self.first = self.first or float(missed.mean())
        known = bool(np.isfinite(answer.std).all())
        inside = coverage(truth, answer.mean, answer.std) if known else np.nan
        node = (missed <= 1.96 * answer.std).mean(axis=(0, 2)).min() if known else np.nan
        east, north, up = missed.mean(axis=(0, 1))
        print(
            f"{name:<44}{missed.mean():9.4f}{self.first / missed.mean():8.1f}{east:8.4f}"
            f"{north:8.4f}{up:8.4f}{np.quantile(distance, 0.99):8.3f}{distance.max():8.3f}"
            f"{inside:7.3f}{node:7.2f}{fit_s:8.1f}{1e3 * tick_s:7.2f}",
            flush=True,
        )


def _ours(race: Race, campaign: CampaignRecord, good: np.ndarray) -> None:
    rest = Cage.from_toml(campaign.cage_toml).design_position
    restarts = 0 if ONCE else 3
    paper, literal = (PcaGP(modes=3, centred=c, restarts=restarts) for c in (True, False))
    race.run("PCA 3 modes + GP, current (the paper's)", paper.fit, 3)
    race.run("  uncentred, M M' literally", literal.fit, 3)
    if campaign.second_moment is not None:
        over_time = OverTime.of_moment(
            campaign.node_position[good], campaign.second_moment, rest_position=rest
        )
        _modes_over_time(race, over_time, rest, restarts)
    race.run("PCA 3 modes + GP, current and waves", paper.fit, 7)
    symmetry = Symmetry.of(rest, fold=4, mirror=0.0)
    ask = {"restarts": restarts, "asymmetry": 1.0 if ONCE else 0.05}
    race.run("ShapeGP, current", ShapeGP(**ask).fit, 3)
    race.run("ShapeGP, current and waves", ShapeGP(**ask).fit, 7)
    folded = ShapeGP(symmetry=symmetry, **ask)
    race.run("  folded by symmetry", folded.fit, 7)
    coarse = ShapeGP(symmetry=symmetry, tolerance=0.02, **ask)
    race.run("  folded, compressed to 2 cm", coarse.fit, 7)
    cage = Cage.from_toml(campaign.cage_toml)
    epochs = 2 if ONCE else None
    networks: list[tuple[str, Literal["paper", "modal"], int]] = [
        ("GCN, the paper's, current", "paper", 3),
        ("GCN, the paper's, current and waves", "paper", 7),
        ("GCN, modal, current and waves", "modal", 7),
    ]
    for name, kind, columns in networks:
        try:
            race.run(name, GCN(cage=cage, kind=kind, epochs=epochs).fit, columns)
        except SeacageError as error:
            print(f"{name:<44}{error}")


def _modes_over_time(race: Race, over_time: OverTime, rest: np.ndarray, restarts: int) -> None:
    """The paper's modes proper: of all time steps, as many as hold 93 % of their variance."""
    for name, centred in (("centred", True), ("displacements, M M' literally", False)):
        model = PcaGP(centred=centred, restarts=restarts)

        def fit(x: np.ndarray, y: np.ndarray, model: PcaGP = model, name: str = name) -> object:
            fitted = model.fit(x, y, over_time=over_time, rest_position=rest)
            print(f"  {name}: {fitted.modes} modes of all time steps hold 93 %:")
            return fitted

        race.run(f"  PCA over time + GP, current, {name}"[:44], fit, 3)


def _peers(race: Race, environment: Path, scratch: Path) -> None:
    for columns in (6, 7):
        # Six columns are those without the period: heights in place of speeds.
        x = race.x if columns == 7 else _without_period(race.x)
        teach, score = slice(-race.held), slice(-race.held, None)
        np.savez(scratch / "in.npz", x_train=x[teach], y_train=race.y[teach], x_test=x[score])
        for method in ("ezyrb-rbf", "ezyrb-gpr"):
            name = f"{method}, current and waves, {columns} features"
            python = environment / "bin" / "python"
            done = subprocess.run(
                [python, PEERS, method, scratch / "in.npz", scratch / "out.npz"],
                capture_output=True,
                text=True,
                check=False,
            )
            if done.returncode:
                print(f"{name:<44}{done.stderr.strip().splitlines()[-1]}")
                continue
            mean = np.load(scratch / "out.npz")["mean"]
            spent = json.loads((scratch / "out.npz.json").read_text("utf-8"))
            unknown = np.full_like(mean, np.nan)
            race.print_line(
                name,
                Prediction(mean=mean, std=unknown),
                fit_s=spent["fit_s"],
                tick_s=spent["tick_s"],
            )


def _without_period(x: np.ndarray) -> np.ndarray:
    speed = np.where(x[:, 3] > 0.0, x[:, 3], 1.0)[:, None]
    return np.column_stack([x[:, :3], x[:, 6], x[:, 6:] * x[:, 4:6] / speed])


def _print_floor(campaign: CampaignRecord, cases: np.ndarray, scratch: Path) -> None:
    """Two half hours of the same sea differ by the noise of both."""
    seas = [campaign.seas[case] for case in cases]
    plan = Plan.listed(seas, seed=campaign.seed + 777, name="again")
    cage = Cage.from_toml(campaign.cage_toml)
    again = run_campaign(cage, plan, scratch / "again", law=campaign.law, workers=1)
    difference = (again.node_position - campaign.node_position[cases])[again.converged]
    mae = np.abs(difference).mean() / np.sqrt(2.0)
    p99 = np.quantile(np.linalg.norm(difference, axis=2), 0.99) / np.sqrt(2.0)
    print(
        f"{len(difference)} cases in other waves: one half-hour mean is {mae:.4f} m from the mean "
        f"of all, MAE, and {p99:.3f} m at p99; no model can be nearer"
    )


def _spent(work: Callable[[], object]) -> float:
    began = time.process_time()
    work()
    return time.process_time() - began


if __name__ == "__main__":
    main()
