"""The models of every level, and their prediction in known water."""

import math
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.cage import Cage, MooringLines, mooring_lines
from seacage.conventions import YEAR
from seacage.surrogates import (
    Domain,
    FittedGaussianProcess,
    FittedShapeGP,
    LoadRatio,
    Prediction,
    Predicts,
)
from seacage.twin._answer import Answer
from seacage.twin._correction import (
    LEAST_SENSORS,
    Correction,
    Corrections,
    NetCorrection,
    WindowErrors,
    discrepancy_std,
    follow_level_1,
    lift_over_simulated,
    relative_discrepancy,
    relative_in_waves,
    unlike,
    variance_by_change,
    volume_std,
    with_discrepancy,
)
from seacage.twin._lines._line_correction import LineCorrection, correct_lines, load_variables
from seacage.twin._lines._line_loads import LineLoads
from seacage.twin._metocean import Input, Metocean, nearest_inside
from seacage.twin._parted import PartedLines
from seacage.twin._profiles import Profiles, mix, without_profile

BLOCK_ROWS = 512  # rows predicted at once: the shapes of more would crowd a small computer's memory
ROUNDING = 1e-9  # what sines and cosines may add to a speed [m/s]

# Either way, of the central difference over the current [m/s]: well below what bends a load
STRIDE = 0.02

Features = Float[np.ndarray, "case feature"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Depth:
    """Level 1 of a depth sensor: how deep its node of the shape lies."""

    height: Predicts  # of the node, upwards [m]

    def predict(self, x: Features, /) -> Prediction:
        """Predict at each row of features [m]."""
        height = self.height.predict(x)
        return Prediction(mean=-height.mean, std=height.std)


@dataclass(frozen=True, kw_only=True, eq=False)
class Models:
    """Level 1 of loads and shape, and level 2 of the sensors that have it."""

    cage: Cage  # as it was simulated, with the places of the sensors
    inputs: tuple[Input, ...]
    domain: Domain  # of the features that level 1 was trained on
    # The largest current speed [m/s] and wave height [m] among them, rounded up to 0.01
    edge: tuple[float, float]
    still_volume: float  # of the shape in still water [m3]
    bridles: FittedGaussianProcess  # level 1 of all bridle tensions [N]
    shape: FittedShapeGP  # level 1 of the node positions [m]
    loads: LineLoads | None = None  # level 1 of all lines' loads in waves, where it was trained
    parted: PartedLines | None = None  # and of what is left of them where one has parted
    # Of models that take the profile, where they are given a current at one depth
    profiles: Profiles | None = None
    # Level 2 by sensor, of its readings [N] or [m]
    upper: Mapping[str, Correction] = field(default_factory=dict[str, Correction])
    # Level 2 of lines' loads in waves, by the name of the shackle
    line_upper: Mapping[str, LineCorrection] = field(default_factory=dict[str, LineCorrection])
    # And of the standard deviation of depths, by the name of the sensor
    depth_ratio: Mapping[str, LoadRatio] = field(default_factory=dict[str, LoadRatio])
    # Errors of level 1 in the windows of each shackle
    line_errors: Mapping[str, WindowErrors] = field(default_factory=dict[str, WindowErrors])

    @cached_property
    def corrections(self) -> Mapping[int, Correction]:
        """Level 2 by the sensor's column, in the cage's order."""
        names = enumerate(self.cage.sensor_names)
        return {column: self.upper[name] for column, name in names if name in self.upper}

    @cached_property
    def together(self) -> Corrections | None:
        """Level 2 of all sensors that have it; None where there is none."""
        models = list(self.corrections.values())
        return Corrections.of(models) if models else None

    @cached_property
    def _lines(self) -> Mapping[int, int]:
        """The bridle of each shackle that has level 2, by the sensor's column."""
        first = len(self.cage.depth_sensors)  # the shackles come after them
        lines = enumerate((one.bridle for one in self.cage.shackles), start=first)
        return {column: line for column, line in lines if column in self.corrections}

    @cached_property
    def relative_discrepancy(self) -> float | None:
        """Of the bridles' simulated loads, as their shackles show it [-]; None where too few do."""
        shackles = [(line, self.corrections[column]) for column, line in self._lines.items()]
        return relative_discrepancy(shackles, self.bridles)

    @cached_property
    def net(self) -> NetCorrection | None:
        """Level 2 of the net; None where too few depth sensors have a calibrated level 2."""
        columns = self._net_columns
        if len(columns) < LEAST_SENSORS:
            return None
        still = Metocean.without_waves(np.zeros((1, 2))).features(self.inputs)
        return NetCorrection(
            shape=self.shape,
            inputs=self.inputs,
            most_speed=self.edge[0],
            still=self.shape.predict(still).mean[0],
            nodes=tuple(self.cage.depth_sensors[column].node for column in columns),
        )

    @cached_property
    def unlike(self) -> str:
        """Why the cage is unlike those of the family, in one sentence; "" where it is not."""
        lifts = list[float]()
        if self.net is not None:
            for column, node in zip(self._net_columns, self.net.nodes, strict=True):
                still = -float(self.net.still[node, 2])
                lifts.append(lift_over_simulated(self.corrections[column], still))
        return unlike(lifts, self.relative_discrepancy)

    @property
    def _net_columns(self) -> list[int]:
        """Columns of the depth sensors whose level 2 is calibrated."""
        sensors = range(len(self.cage.depth_sensors))
        known = self.corrections
        return [one for one in sensors if one in known and known[one].spread.by != "none"]

    @property
    def level_1(self) -> Self:
        """The same without level 2 of any sensor, and so of the net."""
        return replace(self, upper={})

    def lower(self, sensor: str) -> Predicts:
        """Level 1 of one sensor [N] or [m]."""
        for one in self.cage.depth_sensors:
            if one.name == sensor:
                return Depth(height=self.shape.coordinate(one.node, 2))
        (bridle,) = (one.bridle for one in self.cage.shackles if one.name == sensor)
        return self.bridles.output(bridle)

    def with_level_2(self, sensor: str, model: Correction) -> Self:
        """Return a copy that has level 2 of one more sensor."""
        return replace(self, upper={**self.upper, sensor: model})

    def steepness(self, water: Metocean) -> Float[np.ndarray, "case sensor"]:
        """Length of the gradient of each sensor's level 1 over the current [N s/m] or [s]."""
        low = self._sensors_and_bridles(water.sides(STRIDE))[:, : len(self.cage.sensor_names)]
        east, west, north, south = low.reshape(4, len(water), low.shape[1])
        return np.hypot(east - west, north - south) / (2.0 * STRIDE)

    def _sensors_and_bridles(self, water: Metocean) -> Float[np.ndarray, "case output"]:
        """Means of level 1 of the sensors, then of all bridles [m] and [N]."""
        x = water.features(self.inputs)
        nodes = np.array([one.node for one in self.cage.depth_sensors], dtype=int)
        bridle = self.bridles.mean(x)
        lines = [one.bridle for one in self.cage.shackles]
        return np.hstack([-self.shape.mean_of_nodes(x, nodes)[:, :, 2], bridle[:, lines], bridle])

    def _nodes_and_volume(self, water: Metocean) -> Float[np.ndarray, "case output"]:
        """Means of level 1 of the nodes' coordinates [m], then of the volume fraction."""
        shape = self.shape.mean_of_nodes(water.features(self.inputs), slice(None))
        volume = self.cage.volume(shape) / self.still_volume
        return np.hstack([shape.reshape(len(shape), -1), volume[:, None]])

    def answer(self, water: Metocean, trouble: Sequence[str]) -> Answer:
        """Predict in each row of water, with no number where there is trouble with it.

        Outside the domain the variance grows by the square of how far the mean has moved from
        the nearest milder water inside, as the models are not reliable beyond it. Outside its
        own domain, the variance of level 2 grows in the same way. Models that take a profile and
        are given the current at one depth answer for all profiles that it may stand for.
        """
        valid = np.array([not one for one in trouble], dtype=bool)
        known = water.rows(valid)
        blocks = [
            self._block_over_profiles(known.rows(slice(first, first + BLOCK_ROWS)))
            for first in range(0, max(len(known), 1), BLOCK_ROWS)
        ]
        of_rows = _put_in_rows(blocks, np.flatnonzero(valid), len(valid))
        inside = of_rows["in_domain"] | ~valid
        beyond = "" if inside.all() else self._beyond()
        cage, shackles = self.cage, len(self.cage.shackles)
        bridle_level = 1 + np.isin(np.arange(cage.bridle_count), list(self._lines.values()))
        sensor_level = 1 + np.isin(np.arange(len(cage.sensor_names)), list(self.corrections))
        return Answer(
            valid=valid,
            reason=tuple(
                one or ("" if here else beyond) for one, here in zip(trouble, inside, strict=True)
            ),
            bridle_names=cage.bridle_names,
            bridle_level=bridle_level,
            bridle_calibrated=(bridle_level > 1) | (self.relative_discrepancy is not None),
            sensor_names=cage.sensor_names,
            sensor_units=("m",) * (len(sensor_level) - shackles) + ("N",) * shackles,
            sensor_level=sensor_level,
            shape_level=2 if self.net else 1,
            **of_rows,
            **self._line_loads(water, valid, of_rows["bridle_tension"]),
        )

    def _line_loads(
        self, water: Metocean, valid: Bool[np.ndarray, " case"], bridle: Prediction
    ) -> dict[str, Any]:
        """Predict the loads of lines: the fields of an answer about them."""
        sensors = self.cage.depth_sensors
        if self.loads is None:
            return {
                "depth_std": self.depth_std(water, None),
                "depth_std_level": np.ones(len(sensors), dtype=int),
                "line_level": np.zeros(0, dtype=int),
                "line_calibrated": np.zeros(0, dtype=bool),
                "line_in_domain": np.zeros_like(valid),
                "line_reason": ("",) * len(valid),
                "line_tp_assumed": np.zeros_like(valid),
            }
        known = Metocean.from_table(np.where(valid[:, None], water.table, np.nan))
        low, inside, reason = self.loads.predict(known, spread=False)
        motion = self.loads.node_motion(known)
        shackles = {one.name: one.bridle for one in self.cage.shackles}
        upper = {shackles[name]: one for name, one in self.line_upper.items()}
        level = 1 + np.isin(np.arange(len(self.loads.names)), list(upper))
        loads = correct_lines(low, upper, known, bridle)
        rate = self.lines.damage_rate(loads.damage_equivalent.mean)
        assumed = self.loads.gaps(known)[1]
        counts, bridles = inside & ~assumed, self.cage.bridle_count
        relative = relative_in_waves(self.line_errors.values())
        calibrated = level > 1
        if relative is not None:
            calibrated[:bridles] = True
            own_mean = [line for line, one in upper.items() if one.mean]
            loads = with_discrepancy(
                loads, low, relative, bridles=bridles, own_mean=own_mean, rows=counts
            )
        return {
            "node_motion": motion,
            "depth_std": self.depth_std(known, motion),
            "depth_std_level": 1 + np.array([one.name in self.depth_ratio for one in sensors], int),
            "line_names": self.loads.names,
            "line_kinds": self.loads.kinds,
            "line": replace(loads, damage_per_year=np.where(counts[:, None], YEAR * rate, np.nan)),
            "line_level": level,
            "line_calibrated": calibrated,
            "line_in_domain": inside,
            "line_reason": reason,
            "line_tp_assumed": assumed,
        }

    def depth_std(
        self, water: Metocean, motion: Float[np.ndarray, "case node 2"] | None
    ) -> Float[np.ndarray, "case depth"]:
        """Standard deviation of each depth sensor's depth by its best level [m].

        ``motion``: of the nodes, at level 1.
        """
        sensors = self.cage.depth_sensors
        if motion is None:
            return np.full((len(water), len(sensors)), np.nan)
        std = motion[:, [one.node for one in sensors], 1]
        for column, one in enumerate(sensors):
            if one.name in self.depth_ratio:
                variables = load_variables(water, std[:, column])
                std[:, column] *= np.exp(self.depth_ratio[one.name].log(variables, len(water)))
        return std

    @cached_property
    def lines(self) -> MooringLines:
        """Lines whose loads were learned, with their strength."""
        names = self.loads.names if self.loads else ()
        return mooring_lines(self.cage, anchored=True).named(names)

    def _block_over_profiles(self, water: Metocean) -> dict[str, Any]:
        """``_block`` where the profile is known, and its mean over profiles where it is not."""
        if self.profiles is None:
            return self._block(water)
        unknown, members = without_profile(water), len(self.profiles.draws)
        here, other = np.flatnonzero(~unknown), np.flatnonzero(unknown)
        few, blocks = BLOCK_ROWS // members, list[dict[str, Any]]()
        if len(here) or not len(other):
            blocks.append(self._block(water.rows(here).through(self.inputs)))
        for first in range(0, len(other), few):
            each = self.profiles.members(water.rows(other[first : first + few]))
            blocks.append(mix(self._block(each.through(self.inputs)), members))
        return _put_in_rows(blocks, np.concatenate([here, other]), len(water))

    def _block(self, water: Metocean) -> dict[str, Any]:
        """Predict in known water: the fields of an answer that have rows."""
        x = water.features(self.inputs)
        # The box of features leaves a margin, and its corners are faster than any current.
        speed = np.linalg.norm(water.current_velocity, axis=1)
        inside = self.domain.contains(x) & (speed <= self.edge[0] + ROUNDING)
        parts = self._predict(water, x)
        if not inside.all():
            edge_speed, edge_hs = self.edge
            milder = water.rows(~inside).limited(current_speed=edge_speed, hs=edge_hs)
            edge = self._predict(milder, milder.features(self.inputs))
            parts = [_widen(one, end, ~inside) for one, end in zip(parts, edge, strict=True)]
        bridle_low, shape, sensor_low, bridle, sensor = parts
        by_change = 0.0
        if water.current_change is not None and water.current_change.any():
            by_change = self._add_change(water, shape, bridle, sensor)
        bridle_in_domain, sensor_in_domain = self._own_domains(x, inside)
        net, depth = self.net, sensor.mean[:, self._net_columns]
        volume = self.cage.volume(shape.mean) / self.still_volume
        volume_sd = volume_std(volume) if net else np.full_like(volume, np.nan)
        return {
            "in_domain": inside,
            "bridle_in_domain": bridle_in_domain,
            "sensor_in_domain": sensor_in_domain,
            # A rope never pushes, though a Gaussian has negative values.
            "bridle_tension": replace(bridle, mean=np.maximum(bridle.mean, 0.0)),
            "bridle_low": np.maximum(bridle_low.mean, 0.0),
            "sensor": sensor,
            "sensor_low": sensor_low,
            "node_position": shape.mean,
            "node_sigma": shape.std.max(axis=2),
            "node_std": net.std(water, shape, depth) if net else np.full_like(shape.std, np.nan),
            "volume_fraction": volume,
            "volume_std": np.hypot(volume_sd, by_change),
        }

    def _add_change(
        self, water: Metocean, shape: Prediction, bridle: Prediction, sensor: Prediction
    ) -> Float[np.ndarray, " case"]:
        """Add how far the current may have changed to standard deviations; the volume's is left.

        Beyond the fastest water of level 1 nothing more is taken to change.
        """
        columns, count = list(self.corrections), sensor.std.shape[1]

        def within(some: Metocean) -> Metocean:
            return some.limited(current_speed=self.edge[0], hs=math.inf)

        def best(some: Metocean) -> Float[np.ndarray, "case output"]:
            means = self._sensors_and_bridles(within(some))
            if self.together is not None:
                low = Prediction(mean=means[:, columns], std=np.zeros((len(means), len(columns))))
                means[:, columns] = self.level_2(within(some), low, low.std).mean
            return means

        both = variance_by_change(water, best)
        for column, line in self._lines.items():
            both[:, count + line] = both[:, column]
        sd = np.sqrt(both)
        sensor.std[:] = np.hypot(sensor.std, sd[:, :count])
        bridle.std[:] = np.hypot(bridle.std, sd[:, count:])
        there = self.net.water(water, sensor.mean[:, self._net_columns]) if self.net else water
        net = np.sqrt(variance_by_change(there, lambda one: self._nodes_and_volume(within(one))))
        shape.std[:] = np.hypot(shape.std, net[:, :-1].reshape(shape.std.shape))
        return net[:, -1]

    def _own_domains(
        self, x: Features, inside: Bool[np.ndarray, " case"]
    ) -> tuple[Bool[np.ndarray, "case line"], Bool[np.ndarray, "case sensor"]]:
        """Where bridles and sensors are in the domain of the level that answers."""
        bridle = np.tile(inside[:, None], self.cage.bridle_count)
        sensor = np.tile(inside[:, None], len(self.cage.sensor_names))
        for column, model in self.corrections.items():
            sensor[:, column] &= model.domain.contains(x)
        bridle[:, list(self._lines.values())] = sensor[:, list(self._lines)]
        return bridle, sensor

    def _predict(self, water: Metocean, x: Features) -> list[Prediction]:
        """Predict bridles at level 1, the net by its best level, then sensors and bridles likewise.

        A reading has the instrument's noise; the tension of a shackle's bridle has none.
        """
        bridle_low = self.bridles.predict(x)
        nodes = np.array([one.node for one in self.cage.depth_sensors], dtype=int)
        lines = [one.bridle for one in self.cage.shackles]
        # Where the net has level 2, the sensors' nodes are enough of its level 1.
        shape = self.shape.predict_nodes(x, nodes) if self.net else self.shape.predict(x)
        sensed = slice(None) if self.net else nodes
        sensor_low = Prediction(
            mean=np.hstack([-shape.mean[:, sensed, 2], bridle_low.mean[:, lines]]),
            std=np.hstack([shape.std[:, sensed, 2], bridle_low.std[:, lines]]),
        )
        bridle, sensor = deepcopy((bridle_low, sensor_low))
        if self.relative_discrepancy is not None:
            bridle.std[:] = discrepancy_std(bridle_low, self.relative_discrepancy)
        if self.together is not None:
            columns = list(self.corrections)
            low = Prediction(mean=sensor_low.mean[:, columns], std=sensor_low.std[:, columns])
            steepness = np.zeros_like(low.mean)
            if self.together.water_sd.any():
                steepness = self.steepness(water)[:, columns]
            latent = self.level_2(water, low, steepness)
            sensor.mean[:, columns] = latent.mean
            sensor.std[:, columns] = self._widen_outside(x, latent)
            lines, here = list(self._lines.values()), list(self._lines)
            bridle.mean[:, lines] = sensor.mean[:, here]
            bridle.std[:, lines] = sensor.std[:, here]
            if self.net is not None:
                shape = self.net.predict(water, sensor.mean[:, self._net_columns])
            sensor.std[:, columns] = np.sqrt(sensor.std[:, columns] ** 2 + self.together.noise)
        return [bridle_low, shape, sensor_low, bridle, sensor]

    def level_2(
        self, water: Metocean, low: Prediction, steepness: Float[np.ndarray, "case corrected"]
    ) -> Prediction:
        """Predict the corrected sensors' readings without the instruments' noise.

        Beyond the edge of a sensor's training window as that edge says.

        ``low``, ``steepness``: of level 1 of these sensors, there is one at least.
        """
        together, columns = self.together, list(self.corrections)
        assert together is not None, "level 2 of no sensor"
        own = together.latent(water.features(self.inputs), low, steepness)
        speed, weight = np.linalg.norm(water.current_velocity, axis=1), together.edge_weight
        edges = np.unique(together.edge_speed[weight > 0.0])
        rows, edge = np.nonzero(speed[:, None] > edges)
        if len(rows):
            # Each row at each edge that it is beyond; there it counts for the sensors of that edge.
            at_edge = water.rows(rows).limited(current_speed=edges[edge, None], hs=math.inf)
            mean = self._sensors_and_bridles(at_edge)[:, columns]
            low_edge = Prediction(mean=mean, std=low.std[rows])
            here = together.latent(at_edge.features(self.inputs), low_edge, steepness[rows])
            found = follow_level_1(own.rows(rows), here, low.mean[rows] - mean, weight)
            its, sensor = np.nonzero((edges[edge, None] == together.edge_speed) & (weight > 0.0))
            own.mean[rows[its], sensor] = found.mean[its, sensor]
            own.std[rows[its], sensor] = found.std[its, sensor]
        return own

    def _widen_outside(
        self, x: Features, latent: Prediction
    ) -> Float[np.ndarray, "case corrected"]:
        """Widen each level 2 outside its own domain, without a step at its edge."""
        std = latent.std.copy()
        for place, model in enumerate(self.corrections.values()):
            edge = nearest_inside(x, model.domain)
            # Not ``contains``, whose margin would make a step that no table can follow.
            beyond = np.any(np.abs(edge - x) > ROUNDING, axis=1)
            if beyond.any():
                edge = edge[beyond]
                there = model.latent(edge, model.rest.lower.predict(edge)).mean
                moved = latent.mean[beyond, place] - there
                std[beyond, place] = np.hypot(std[beyond, place], moved)
        return std

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
    return replace(here, std=std)


def _put_in_rows(
    blocks: Sequence[Mapping[str, Any]], rows: Int[np.ndarray, " row"], count: int
) -> dict[str, Any]:
    """Fields of blocks, one after another, in some of so many rows; False or NaN elsewhere."""

    def put(parts: Sequence[Any]) -> Any:
        if isinstance(parts[0], Prediction):
            mean, std = (put([getattr(one, key) for one in parts]) for key in ("mean", "std"))
            return Prediction(mean=mean, std=std)
        values = np.concatenate(parts)
        every = np.full((count, *values.shape[1:]), False if values.dtype == bool else np.nan)
        every[rows] = values
        return every

    return {name: put([block[name] for block in blocks]) for name in blocks[0]}
