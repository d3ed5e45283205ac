"""The models of every level, and their prediction in known water."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.cage import Cage
from seacage.surrogates import (
    Domain,
    FittedGaussianProcess,
    FittedShapeGP,
    Prediction,
    Predicts,
)
from seacage.twin._answer import Answer
from seacage.twin._correction import Correction, Corrections
from seacage.twin._metocean import Input, Metocean, nearest_inside

BLOCK_ROWS = 512
"""Rows predicted at once: the shapes of more would crowd a small computer's memory."""

ROUNDING = 1e-9
"""What sines and cosines may add to a speed [m/s]."""

STRIDE = 0.02
"""Either way, of the central difference over the current [m/s]: well below what bends a load."""

Features = Float[np.ndarray, "case feature"]
Numbers = dict[str, Float[np.ndarray, "case *rest"]]
"""By quantity; a mean and its standard deviation side by side."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Depth:
    """Level 1 of a depth sensor: how deep its node of the shape lies.

    Parameters
    ----------
    height
        Of the node, upwards [m].
    """

    height: Predicts

    def predict(self, x: Features, /) -> Prediction:
        """Predict at each row of features [m]."""
        height = self.height.predict(x)
        return Prediction(mean=-height.mean, std=height.std)


@dataclass(frozen=True, kw_only=True, eq=False)
class Models:
    """Level 1 of loads and shape, and level 2 of the sensors that have it.

    Parameters
    ----------
    cage
        As it was simulated, with the places of the sensors.
    inputs
        Inputs of the models.
    domain
        Of the features that level 1 was trained on.
    edge
        The largest current speed [m/s] and wave height [m] among them, rounded up to 0.01.
    still_volume
        Of the shape in still water [m3].
    bridles
        Level 1 of all bridle tensions [N].
    shape
        Level 1 of the node positions [m].
    upper
        Level 2 by sensor, of its readings [N] or [m].
    """

    cage: Cage
    inputs: tuple[Input, ...]
    domain: Domain
    edge: tuple[float, float]
    still_volume: float
    bridles: FittedGaussianProcess
    shape: FittedShapeGP
    upper: Mapping[str, Correction] = field(default_factory=dict[str, Correction])

    @cached_property
    def together(self) -> Corrections | None:
        """Level 2 of the cage's sensors, in their order; None where there is none."""
        models = [self.upper[name] for name in self.upper_domains]
        return Corrections.of(models) if models else None

    @cached_property
    def upper_domains(self) -> Mapping[str, Domain]:
        """Of the features that trained level 2, by sensor, in the cage's order."""
        names = [name for name in self.cage.sensor_names if name in self.upper]
        return {name: self.upper[name].domain for name in names}

    def lower(self, sensor: str) -> Predicts:
        """Level 1 of one sensor [N] or [m]."""
        nodes = {one.name: one.node for one in self.cage.depth_sensors}
        if sensor in nodes:
            return Depth(height=self.shape.coordinate(nodes[sensor], 2))
        return self.bridles.output(self._lines()[sensor])

    def with_level_2(self, sensor: str, model: Correction) -> Self:
        """Return a copy that has level 2 of one more sensor."""
        return replace(self, upper={**self.upper, sensor: model})

    def steepness(self, water: Metocean) -> Float[np.ndarray, "case sensor"]:
        """Length of the gradient of each sensor's level 1 over the current [N s/m] or [s]."""
        ways = STRIDE * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
        around = water.rows(np.tile(np.arange(len(water)), len(ways)))
        velocity = around.current_velocity + np.repeat(ways, len(water), axis=0)
        x = replace(around, current_velocity=velocity).features(self.inputs)
        nodes = np.array([one.node for one in self.cage.depth_sensors], dtype=int)
        lines = [one.bridle for one in self.cage.shackles]
        depth = -self.shape.mean_of_nodes(x, nodes)[:, :, 2]
        low = np.hstack([depth, self.bridles.mean(x)[:, lines]])
        east, west, north, south = low.reshape(len(ways), len(water), low.shape[1])
        return np.hypot(east - west, north - south) / (2.0 * STRIDE)

    def answer(self, water: Metocean, trouble: Sequence[str]) -> Answer:
        """Predict in each row of water, with no number where there is trouble with it.

        Outside the domain the variance grows by the square of how far the mean has moved from
        the nearest milder water inside, as the models are not reliable beyond it. Outside its
        own domain, the variance of level 2 grows in the same way.
        """
        valid = np.array([not one for one in trouble], dtype=bool)
        rows = np.flatnonzero(valid)
        inside = self._inside(water.rows(rows))
        blocks = [
            self._numbers(water.rows(rows[part]), inside[part])
            for part in (
                slice(first, first + BLOCK_ROWS)
                for first in range(0, max(len(rows), 1), BLOCK_ROWS)
            )
        ]
        numbers = {
            name: _fill_valid([block[name] for block in blocks], valid) for name in blocks[0]
        }
        in_domain = valid.copy()
        in_domain[rows] = inside
        bridle_in_domain, sensor_in_domain = self._own_domains(water, in_domain)
        beyond = self._beyond()
        return Answer(
            valid=valid,
            in_domain=in_domain,
            bridle_in_domain=bridle_in_domain,
            sensor_in_domain=sensor_in_domain,
            reason=tuple(
                one or ("" if here else beyond)
                for one, here in zip(trouble, in_domain, strict=True)
            ),
            bridle_names=self.cage.bridle_names,
            bridle_tension=_prediction(numbers, "bridle"),
            bridle_low=numbers["bridle_low_mean"],
            bridle_level=self._bridle_level(),
            sensor_names=self.cage.sensor_names,
            sensor_units=self._sensor_units(),
            sensor=_prediction(numbers, "sensor"),
            sensor_low=_prediction(numbers, "sensor_low"),
            sensor_level=np.array([self._level(name) for name in self.cage.sensor_names]),
            node_position=numbers["node_position"],
            node_sigma=numbers["node_sigma"],
            shape_level=1,
            volume_fraction=numbers["volume_fraction"],
        )

    def _inside(self, water: Metocean) -> Bool[np.ndarray, " case"]:
        # The box of features leaves a margin, and its corners are faster than any current.
        speed = np.linalg.norm(water.current_velocity, axis=1)
        trained = self.domain.contains(water.features(self.inputs))
        return trained & (speed <= self.edge[0] + ROUNDING)

    def _own_domains(
        self, water: Metocean, in_domain: Bool[np.ndarray, " case"]
    ) -> tuple[Bool[np.ndarray, "case line"], Bool[np.ndarray, "case sensor"]]:
        """Where bridles and sensors are in the domain of the level that answers."""
        bridle = np.tile(in_domain[:, None], self.cage.bridle_count)
        sensor = np.tile(in_domain[:, None], len(self.cage.sensor_names))
        rows, lines = np.flatnonzero(in_domain), self._lines()
        x = water.rows(rows).features(self.inputs)
        for name, domain in self.upper_domains.items():
            column = self.cage.sensor_names.index(name)
            sensor[rows, column] = domain.contains(x)
            if name in lines:
                bridle[:, lines[name]] = sensor[:, column]
        return bridle, sensor

    def _numbers(self, water: Metocean, inside: Bool[np.ndarray, " case"]) -> Numbers:
        parts = self._predict(water)
        if not inside.all():
            speed, hs = self.edge
            milder = water.rows(~inside).limited(current_speed=speed, hs=hs)
            edge = self._predict(milder)
            parts = {name: _widen(one, edge[name], ~inside) for name, one in parts.items()}
        shape = parts.pop("shape")
        numbers = {f"{name}_mean": one.mean for name, one in parts.items()}
        numbers |= {f"{name}_std": one.std for name, one in parts.items()}
        # A rope never pushes, though a Gaussian has negative values.
        for name in ("bridle_mean", "bridle_low_mean"):
            numbers[name] = np.maximum(numbers[name], 0.0)
        return numbers | {
            "node_position": shape.mean,
            "node_sigma": shape.std.max(axis=2),
            "volume_fraction": self.cage.volume(shape.mean) / self.still_volume,
        }

    def _predict(self, water: Metocean) -> dict[str, Prediction]:
        x = water.features(self.inputs)
        bridle, shape = self.bridles.predict(x), self.shape.predict(x)
        low = self._sensor_low(bridle, shape)
        parts = {"bridle_low": bridle, "shape": shape, "sensor_low": low}
        return parts | self._level_2(water, bridle, low)

    def _sensor_low(self, bridle: Prediction, shape: Prediction) -> Prediction:
        nodes = [one.node for one in self.cage.depth_sensors]
        lines = [one.bridle for one in self.cage.shackles]
        return Prediction(
            mean=np.hstack([-shape.mean[:, nodes, 2], bridle.mean[:, lines]]),
            std=np.hstack([shape.std[:, nodes, 2], bridle.std[:, lines]]),
        )

    def _level_2(
        self, water: Metocean, bridle_low: Prediction, sensor_low: Prediction
    ) -> dict[str, Prediction]:
        """Predict tensions and readings by the best level.

        A reading has the instrument's noise; the tension of a shackle's bridle has none.
        """
        bridle, sensor = _copy(bridle_low), _copy(sensor_low)
        if self.together is None:
            return {"bridle": bridle, "sensor": sensor}
        corrected = np.array([name in self.upper for name in self.cage.sensor_names])
        low = Prediction(mean=sensor_low.mean[:, corrected], std=sensor_low.std[:, corrected])
        steepness = np.zeros_like(low.mean)
        if self.together.water_sd.any():
            steepness = self.steepness(water)[:, corrected]
        x = water.features(self.inputs)
        latent = self.together.latent(x, low, steepness)
        latent = self._widen_outside(x, latent)
        sensor.mean[:, corrected] = latent.mean
        sensor.std[:, corrected] = np.sqrt(latent.std**2 + self.together.noise)
        lines = [line for name, line in self._lines().items() if name in self.upper]
        if lines:  # the shackles are the last of the sensors
            bridle.mean[:, lines] = latent.mean[:, -len(lines) :]
            bridle.std[:, lines] = latent.std[:, -len(lines) :]
        return {"bridle": bridle, "sensor": sensor}

    def _widen_outside(self, x: Features, latent: Prediction) -> Prediction:
        """Widen each level 2 outside its own domain, without a step at its edge."""
        std = latent.std.copy()
        for column, (name, domain) in enumerate(self.upper_domains.items()):
            edge = nearest_inside(x, domain)
            # Not ``contains``, whose margin would make a step that no table can follow.
            beyond = np.any(np.abs(edge - x) > ROUNDING, axis=1)
            if beyond.any():
                edge = edge[beyond]
                there = self.upper[name].latent(edge, self.lower(name).predict(edge)).mean
                std[beyond, column] = np.hypot(
                    std[beyond, column], latent.mean[beyond, column] - there
                )
        return Prediction(mean=latent.mean, std=std)

    def _lines(self) -> dict[str, int]:
        return {one.name: one.bridle for one in self.cage.shackles}

    def _level(self, sensor: str) -> int:
        return 2 if sensor in self.upper else 1

    def _bridle_level(self) -> Int[np.ndarray, " line"]:
        level = np.ones(self.cage.bridle_count, dtype=int)
        for name, line in self._lines().items():
            level[line] = self._level(name)
        return level

    def _sensor_units(self) -> tuple[str, ...]:
        return tuple("N" if name in self._lines() else "m" for name in self.cage.sensor_names)

    def _beyond(self) -> str:
        speed, hs = self.edge
        waves = f" and waves up to {hs:.2f} m" if "waves" in self.inputs else ""
        return (
            f"Extrapolating: level 1 was trained on currents up to {speed:.2f} m/s{waves}; "
            "the spread is widened."
        )


def _widen(here: Prediction, edge: Prediction, beyond: Bool[np.ndarray, " case"]) -> Prediction:
    """Add in quadrature how far the mean moved between the edge and the rows beyond it."""
    std = here.std.copy()
    std[beyond] = np.hypot(std[beyond], here.mean[beyond] - edge.mean)
    return Prediction(mean=here.mean, std=std)


def _copy(prediction: Prediction) -> Prediction:
    return Prediction(mean=prediction.mean.copy(), std=prediction.std.copy())


def _fill_valid(
    parts: Sequence[Float[np.ndarray, "_ *rest"]], valid: Bool[np.ndarray, " case"]
) -> Float[np.ndarray, "case *rest"]:
    """Values of the valid rows, in all rows, NaN elsewhere."""
    values = np.concatenate(parts)
    if len(values) == len(valid):
        return values
    scattered = np.full((len(valid), *values.shape[1:]), np.nan)
    scattered[valid] = values
    return scattered


def _prediction(numbers: Numbers, name: str) -> Prediction:
    return Prediction(mean=numbers[f"{name}_mean"], std=numbers[f"{name}_std"])
