"""The hidden parameters of a virtual field: one file, whose hash its records carry."""

import hashlib
import math
from dataclasses import MISSING, dataclass, field, fields, is_dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any, Literal, Self, get_args, get_origin

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.campaigns._cases import Simulator
from seacage.campaigns._virtual_field._family import Water, draw_truth
from seacage.conventions import InputError, parse_toml, read_text
from seacage.dynamics import law_label

_OWN = resources.files("seacage.campaigns._virtual_field") / "hidden_ace.toml"


@dataclass(frozen=True, slots=True, kw_only=True)
class NettingTruth:
    """Differences of the true net from the drawn one."""

    elastic_modulus_pa: float
    refined: int


@dataclass(frozen=True, slots=True, kw_only=True)
class FoulingTruth:
    """Growth of the net and the solidity that it adds."""

    shallow_least: float
    shallow_most: float
    deep_share: float
    boundary_depth_m: float
    half_grown_days: float
    growth_days: float
    cleaned_days: tuple[float, ...]
    soft_drag_factor: float
    age_days: float = 0.0  # since the last cleaning, when the record begins

    def grown(self, day: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """Growth on a day of the record, 0 just cleaned, 1 grown out [-]."""
        begun = np.array([-self.age_days, *sorted(self.cleaned_days)])
        age = day - begun[np.searchsorted(begun[1:], day, side="right")]
        return 1.0 / (1.0 + np.exp(-(age - self.half_grown_days) / self.growth_days))

    def shallow(self, growth: float) -> float:
        """Solidity added above the boundary depth [-]."""
        return self.shallow_least + growth * (self.shallow_most - self.shallow_least)

    def solidity_and_drag(
        self, growth: float, depth: Float[np.ndarray, " panel"]
    ) -> tuple[Float[np.ndarray, " panel"], Float[np.ndarray, " panel"]]:
        """Solidity added at some depths [m], and the drag factor of what grew there [-]."""
        shallow = self.shallow(growth)
        solidity = np.where(depth < self.boundary_depth_m, shallow, self.deep_share * shallow)
        soft = 1.0 - (1.0 - self.soft_drag_factor) * growth
        return solidity, np.full(len(depth), soft)


@dataclass(frozen=True, slots=True, kw_only=True)
class BridlesTruth:
    """Scatter of the bridles' lengths, and bounds of their pretension over that drawn."""

    length_sd_m: float
    pretension_least: float
    pretension_most: float


@dataclass(frozen=True, slots=True, kw_only=True)
class FrameTruth:
    """Bounds of the slack of the frame's ropes, and how far its corners are from their places."""

    slack_least_m: float
    slack_most_m: float
    corner_sd_m: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class CollarTruth:
    """Bounds of the number of brackets that hold the collar's pipes together."""

    brackets_least: int
    brackets_most: int


@dataclass(frozen=True, slots=True, kw_only=True)
class BuiltTruth:
    """Parts over those drawn [-]; of the tube's weight, the share lost on one side."""

    twine_diameter: float = 1.0
    tube_weight: float = 1.0
    tip_weight: float = 1.0
    rope_stiffness: float = 1.0
    anchor_pretension: float = 1.0
    buoyancy: float = 1.0
    tube_lost: float = 0.0

    def build(self, cage: Cage) -> Cage:
        """The cage with its parts as they were built."""
        bridles, frame, anchors = cage.bridles, cage.frame, cage.anchor_lines
        lost = self.tube_lost > 0.0
        return cage.altered(
            netting={"twine_diameter_m": cage.netting.twine_diameter * self.twine_diameter},
            sinker_tube={
                "weight_n_m": cage.sinker_tube.weight * self.tube_weight,
                **({"lost_from_deg": 0.0, "lost_to_deg": 360.0 * self.tube_lost} if lost else {}),
            },
            tip={"weight_n": cage.tip.weight * self.tip_weight},
            bridles={"rope_axial_stiffness_n": bridles.rope_axial_stiffness * self.rope_stiffness},
            frame={
                "rope_axial_stiffness_n": frame.rope_axial_stiffness * self.rope_stiffness,
                "buoy_buoyancy_n": frame.buoy_buoyancy * self.buoyancy,
            },
            anchor_lines={
                "rope_axial_stiffness_n": anchors.rope_axial_stiffness * self.rope_stiffness,
                "pretension_n": anchors.pretension * self.anchor_pretension,
            },
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class LinesTruth:
    """Stiffening of ropes under load."""

    stiffer_from_strain: float
    stiffer_share: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ProfileTruth:
    """Profile of the current over depth, and its slow random change.

    ``shear_sd_m_s``: of each component of what is added at the deepest, in proportion above it.
    """

    depth_m: tuple[float, ...]
    factor: tuple[float, ...]
    turned_deg: tuple[float, ...]
    factor_sd: float
    turned_sd_deg: float
    memory_s: float
    shear_sd_m_s: float = 0.0
    shear_memory_s: float = 7200.0


@dataclass(frozen=True, slots=True, kw_only=True)
class WavesTruth:
    """Waves at the cage."""

    components: int
    spreading: float
    sheltered: float
    hs_most_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class CurrentTruth:
    """Change of the current between the buoy and the cage."""

    factor_least: float
    factor_most: float
    factor_most_to_deg: float
    turn_least_deg: float
    turn_most_deg: float
    turn_most_to_deg: float
    distance_m: float
    lag_most_s: float
    residual_sd_m_s: float
    residual_memory_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class BuoyTruth:
    """Errors of the buoy's readings."""

    speed_sd_m_s: float
    direction_sd_deg: float
    spike_m_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ShackleTruth:
    """Errors of the load shackles, and when they were alive."""

    gain: float
    bias_kn: float
    noise_sd_kn: float
    spike_kn: float
    windows: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class DepthTruth:
    """Errors of the depth sensors."""

    noise_sd_m: float
    drift_m_week: float
    spike_m: float
    air_pressure_sd_hpa: float
    air_pressure_memory_s: float
    m_per_hpa: float


@dataclass(frozen=True, slots=True, kw_only=True)
class OutagesTruth:
    """Faults that every sensor has now and then."""

    lost_share: float
    gaps_per_week: float
    gap_mean_h: float
    spikes_per_week: float
    stuck_per_week: float
    stuck_mean_h: float
    radio_losses_per_week: float
    radio_loss_mean_h: float


@dataclass(frozen=True, slots=True, kw_only=True)
class TruthParameters:
    """The truth behind a virtual field, which no training may read.

    ``TruthParameters.read()`` is the one of cage ``ace``; its file says what each number means.
    ``TruthParameters.of_family(7)`` is one of many, drawn by its number.
    """

    law: str
    seed: int
    skin_friction: float | None = None
    lift_factor: float = 1.0
    built: BuiltTruth = field(default_factory=BuiltTruth)
    netting: NettingTruth
    fouling: FoulingTruth
    bridles: BridlesTruth
    frame: FrameTruth
    collar: CollarTruth
    lines: LinesTruth
    current: CurrentTruth
    profile: ProfileTruth
    waves: WavesTruth
    buoy: BuoyTruth
    shackle: ShackleTruth
    depth: DepthTruth
    outages: OutagesTruth
    sha256: str
    # What the notes of its records say of it
    title: str = ""

    def __post_init__(self) -> None:
        law_label(self.law)  # refused now where it is not installed

    @classmethod
    def read(cls, path: str | Path | None = None) -> Self:
        """Hidden parameters from a TOML file; None for those of cage ``ace``.

        Raises InputError: no TOML, or a key that is unknown, missing or no finite number.
        """
        text = _OWN.read_text("utf-8") if path is None else read_text(path)
        table = parse_toml(text, f"{path or _OWN}")
        return _build(cls, {**table, "sha256": _sha256(text)}, where=f"{path or _OWN}")

    @classmethod
    def of_family(cls, number: int, *, water: Water = "tame", unseal: bool = False) -> Self:
        """One of a family of hidden cages and waters, drawn from the ranges of ``family.toml``.

        ``number``: 1 to 60 for development; 101 to 110 are sealed, so that no setting is ever
        fitted to them; 201 to 204 lie outside the ranges: another screen law, a current sheared
        twice, an uneven frame, a sinker tube that lost its weight on one side; 301 to 400 are
        fresh, for figures on cages that chose no setting.
        ``water``: "tame" as on the shelf, "coastal", with the shear that two ADCPs measured, or
        "shallow", as the one in the shallower water did. Of one number all have the same cage.
        ``unseal``: give a sealed one.

        Raises InputError: a number or a water that is none, or one that is sealed.
        """
        text = _OWN.read_text("utf-8")
        table, drawn_from = draw_truth(parse_toml(text, f"{_OWN}"), number, water, unseal=unseal)
        named = f"{_sha256(text)}, {drawn_from}, truth {number}, {water}"
        identity = {"sha256": _sha256(named), "title": f"Truth {number}, {water} water."}
        return _build(cls, table | identity, where=f"Truth {number}")

    def drawn(self, seed: int) -> Self:
        """The same ranges, from which another seed draws the cage; the hash names the seed too."""
        return replace(self, seed=seed, sha256=_sha256(f"{self.sha256}, seed {seed}"))

    @property
    def equilibria(self) -> Simulator:
        """What gives the true cage's equilibria."""
        return Simulator(method="settle", **self.net_loads)

    @property
    def net_loads(self) -> dict[str, Any]:
        """Law of the netting with its numbers, as simulations take them."""
        names = ("law", "skin_friction", "lift_factor")
        return {name: getattr(self, name) for name in names}

    def true_cage(self, cage: Cage, growth: float) -> Cage:
        """The cage as it truly is, its net grown by a share of the whole growth, 0 to 1."""
        own, shallow = self.fouling, self.fouling.shallow(growth)
        deep, boundary = own.deep_share * shallow, own.boundary_depth_m
        return self._build(cage).fouled(shallow=shallow, deep=deep, boundary_depth=boundary)

    def fine_cage(self, cage: Cage) -> Cage:
        """The true cage on a finer mesh, whose nodes include those drawn; nothing grows on it.

        Ropes run on all of the new meridians, as strong together as those drawn.
        """
        times, drawn = self.netting.refined, cage.ropes
        stiffness, diameter = drawn.axial_stiffness / times, drawn.diameter / math.sqrt(times)
        ropes = {"axial_stiffness_n": stiffness, "diameter_m": diameter}
        return self._build(cage).refined(times).altered(ropes=ropes)

    def _build(self, cage: Cage) -> Cage:
        """The cage as riggers left it: what is drawn from the ranges depends on the seed alone."""
        rng, collar = np.random.default_rng(self.seed), self.collar
        bridles, frame = self.bridles, self.frame
        offset = rng.normal(scale=bridles.length_sd_m, size=cage.bridle_count)
        tighter = rng.uniform(bridles.pretension_least, bridles.pretension_most)
        slack = rng.uniform(frame.slack_least_m, frame.slack_most_m)
        brackets = rng.integers(collar.brackets_least, collar.brackets_most, endpoint=True)
        cage = self.built.build(self._move_corners(cage, rng))
        return cage.altered(
            netting={"elastic_modulus_pa": self.netting.elastic_modulus_pa},
            bridles={
                "length_offset_m": offset.tolist(),
                "pretension_n": cage.bridles.pretension * tighter,
            },
            frame={"rope_slack_m": cage.frame.rope_slack + slack},
            # Pipes of which nobody knows how far they are apart are computed as sliding.
            collar={"brackets": int(brackets)} if cage.collar.brackets else {},
        )

    def _move_corners(self, cage: Cage, rng: np.random.Generator) -> Cage:
        if self.frame.corner_sd_m == 0.0:
            return cage
        drawn = cage.frame.corners
        moved = drawn + rng.normal(scale=self.frame.corner_sd_m, size=drawn.shape)
        east, north = map(tuple, moved.T.tolist())
        frame = replace(cage.frame, side=None, corners_east=east, corners_north=north)
        return replace(cage, frame=frame)


def _build(kind: Any, table: dict[str, Any], *, where: str) -> Any:
    """A frozen value from a table that has its keys, all of them and no other."""
    kinds = {one.name: one.type for one in fields(kind)}
    needed = {one.name for one in fields(kind) if one.default is one.default_factory is MISSING}
    wrong = sorted((needed - table.keys()) | (table.keys() - kinds.keys()))
    if wrong:
        raise InputError(
            f"{where}: the key {wrong[0]!r} is {'missing' if wrong[0] in kinds else 'unknown'}. "
            "Compare with the hidden parameters that come with seacage."
        )
    return kind(**{k: _value(kinds[k], v, where=f"{where}, {k}") for k, v in table.items()})


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _value(kind: Any, value: Any, *, where: str) -> Any:
    if is_dataclass(kind):
        return _build(kind, value if isinstance(value, dict) else {}, where=where)
    if get_origin(kind) is tuple and isinstance(value, list):
        return tuple(_value(get_args(kind)[0], item, where=where) for item in value)
    if get_origin(kind) is Literal and value not in get_args(kind):
        raise InputError(f"{where}: {value!r} is none of {', '.join(get_args(kind))}.")
    if kind in (int, float, float | None) and not (
        type(value) in (int, float) and math.isfinite(value)
    ):
        raise InputError(f"{where}: {value!r} is no finite number.")
    return value
