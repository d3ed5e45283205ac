"""A moored net cage: its parts, and the graph of nodes that they span."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import cached_property
from importlib import resources
from typing import Any, Self

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import _graph, _parts
from seacage.cage._nearest import Nearest, Node3, Point3, nearest_on_net
from seacage.cage._tangent_plane import TangentPlane
from seacage.cage._toml import TomlFile, alter
from seacage.conventions import InputError, NonsenseError, parse_toml, towards


@dataclass(frozen=True, slots=True, kw_only=True)
class Shackle:
    """A load shackle: the name of its stream and the index of its bridle, from 0."""

    name: str
    bridle: int


@dataclass(frozen=True, slots=True, kw_only=True)
class DepthSensor:
    """A depth sensor: the name of its stream and the node it sits on."""

    name: str
    node: int


# No slots here: what is derived from the parts is computed once and kept.
@dataclass(frozen=True, kw_only=True)
class Cage(TomlFile):
    """A cage as its file describes it, with the node graph derived from it.

    ``Cage.named("ace")`` is the reference cage, ``Cage.read("mine.toml")`` one's own; ``.write``
    makes a file to start from. Positions are x east, y north, z up [m] with z = 0 at still water.
    """

    name: str = field(metadata={"unit": "", "meaning": "the name of the cage"})
    heading: float = _parts.quantity(
        "deg", "how far the whole cage is turned clockwise", low=-360.0
    )
    site: _parts.Site
    mesh: _parts.Mesh
    collar: _parts.Collar
    netting: _parts.Netting
    ropes: _parts.Ropes
    sinker_tube: _parts.SinkerTube
    tip: _parts.Tip
    frame: _parts.Frame
    anchor_lines: _parts.AnchorLines
    bridles: _parts.Bridles
    shackle: tuple[_parts.ShackleEntry, ...] = ()
    depth_sensor: tuple[_parts.DepthSensorEntry, ...] = ()

    def __post_init__(self) -> None:
        _parts.check_bounds(self, f"Cage {self.name}")
        names = self.sensor_names
        if len(set(names)) != len(names):
            raise InputError(f"Cage {self.name}: two sensors share a name in {list(names)}.")
        for entry in self.shackle:
            if entry.bridle > self.bridle_count:
                raise InputError(
                    f"Cage {self.name}: {entry.name} sits on bridle {entry.bridle}, but there "
                    f"are {self.bridle_count}. Bridles are numbered from 1."
                )
        self._check_place()

    def _check_place(self) -> None:
        """Refuse a cage that its water or its mooring has no room for."""
        deepest, water = max(self.mesh.tip_depth, self.frame.depth), self.site.water_depth
        if deepest >= water:
            raise InputError(
                f"Cage {self.name}: it hangs {deepest:g} m deep in water of {water:g} m, and "
                "no bed carries it. Check water_depth_m, tip_depth_m and the frame's depth_m."
            )
        if self.frame.reach <= self.collar.radius:
            raise InputError(
                f"Cage {self.name}: its frame has no room for a collar of radius_m = "
                f"{self.collar.radius:g}: a side is {self.frame.reach:g} m from the centre. Check "
                "the frame's side_m or corners."
            )

    # Doors

    @classmethod
    def named(cls, name: str) -> Self:
        """A cage that comes with seacage."""
        shelf = resources.files("seacage.cage") / "cages"
        known = sorted(entry.name.removesuffix(".toml") for entry in shelf.iterdir())
        if name not in known:
            raise InputError(
                f"Cage.named: no cage {name!r}; there are: {', '.join(known)}. "
                "Read your own with Cage.read."
            )
        return cls.from_toml((shelf / f"{name}.toml").read_text("utf-8"), source=f"{name}.toml")

    @classmethod
    def from_toml(cls, text: str, *, source: str = "") -> Self:
        """Read TOML text; ``source`` names it in errors. A ``Structure``'s is refused."""
        if "ring" in parse_toml(text, source or "cage"):
            raise NonsenseError(
                f"{source or 'cage'}: a structure of rings, nets and lines can be simulated, alone "
                "and in campaigns, but has no twin, drawn mooring or animation. Give a cage's file."
            )
        return super().from_toml(text, source=source)

    @property
    def sha256(self) -> str:
        """Hash of the whole cage."""
        return hashlib.sha256(self.to_toml().encode()).hexdigest()

    # Changed copies

    def altered(self, **sections: Mapping[str, Any]) -> Self:
        """A copy with some parameters changed, each named as in the cage file.

        ``cage.altered(tip={"weight_n": 9800.0}, netting={"twine_diameter_m": 0.003})``
        """
        parts = {p.name: getattr(self, p.name) for p in fields(self) if is_dataclass(p.type)}
        for name in sections:
            if name not in parts:
                raise InputError(
                    f"Cage.altered: no section {name!r}; there are: {', '.join(parts)}."
                )
        where = "Cage.altered"
        changed = {n: alter(parts[n], keys, f"{where}, {n}") for n, keys in sections.items()}
        return replace(self, **changed)

    def fouled(self, *, shallow: float, deep: float, boundary_depth: float = 10.0) -> Self:
        """A copy whose netting has grown: solidity added above and below a depth [m]."""
        growth = {"fouling_shallow": shallow, "fouling_deep": deep}
        return self.altered(netting={**growth, "fouling_boundary_depth_m": boundary_depth})

    def rotated(self, degrees: float) -> Self:
        """A copy turned clockwise, mooring and sensors with it."""
        return replace(self, heading=(self.heading + degrees) % 360.0)

    def drawn(self, seed: int) -> Self:
        """A copy whose mooring is drawn from the uncertainty that the file states.

        Normal, each about the file's value: the bridles' pretension, with what they share; the
        length of each bridle; the slack of the frame ropes, with what they share. Drawn values
        stay in the file's bounds, the pretension above a tenth of the file's.

        Raises InputError: a file that states none of ``pretension_sd_n``, ``length_sd_m``,
        ``rope_slack_sd_m``.
        """
        bridles, frame = self.bridles, self.frame
        spread = (bridles.pretension_sd, bridles.length_sd, frame.rope_slack_sd)
        if not any(spread):
            raise InputError(
                f"Cage {self.name}: its file states no uncertainty of the mooring. Add "
                "pretension_sd_n or length_sd_m to [bridles], or rope_slack_sd_m to [frame]."
            )
        pretension_sd, length_sd, slack_sd = (value or 0.0 for value in spread)
        normal = np.random.default_rng(seed).standard_normal(2 + self.bridle_count)
        pretension = max(bridles.pretension + pretension_sd * normal[0], 0.1 * bridles.pretension)
        offset = np.maximum(np.array(bridles.length_offset) + length_sd * normal[2:], -5.0)
        slack = max(frame.rope_slack + slack_sd * normal[1], -1.0)
        held = {"pretension_n": float(pretension), "length_offset_m": offset.tolist()}
        return self.altered(bridles=held, frame={"rope_slack_m": float(slack)})

    def refined(self, times: int = 2) -> Self:
        """A copy with so many times the rings and spokes; every old node stays a node."""
        between = np.arange(times) / times
        depths = np.array([*self.mesh.ring_depths, self.mesh.tip_depth])
        finer = (depths[:-1, None] + np.diff(depths)[:, None] * between).ravel().tolist()
        mesh = {"ring_depths_m": finer, "spokes": times * self.spokes}
        even = self.altered(mesh=mesh)
        angles = self.spoke_angles[:, None] + self.sectors[:, None] * between
        if self.mesh.spoke_bearings is None and np.allclose(even.spoke_angles, angles.ravel()):
            return even
        bearings = (90.0 - np.rad2deg(angles.ravel())) % 360.0
        return self.altered(mesh={**mesh, "spoke_bearings_deg": bearings.tolist()})

    # The graph

    @property
    def rings(self) -> int:
        """Number of rings, the collar included and the tip not."""
        return len(self.mesh.ring_depths)

    @property
    def spokes(self) -> int:
        """Number of spokes."""
        return self.mesh.spokes

    @property
    def node_count(self) -> int:
        """Rings × spokes and the tip."""
        return self.rings * self.spokes + 1

    @property
    def bottom_node(self) -> int:
        """The tip of the cone."""
        return self.node_count - 1

    def node(self, ring: int, spoke: int) -> int:
        """Index of a node; spokes count round and round."""
        return self.spokes * ring + spoke % self.spokes

    def ring_nodes(self, ring: int) -> Int[np.ndarray, " spoke"]:
        """Nodes of one ring, counter-clockwise seen from above."""
        return self.spokes * ring + np.arange(self.spokes)

    @property
    def pipe_diameter(self) -> float:
        """Of a pipe of the collar, which waves are long against [m]."""
        return self.collar.pipe_diameter

    @property
    def tube_ring(self) -> int:
        """The ring at the cylinder's lower edge, which carries the sinker tube."""
        return self.mesh.ring_depths.index(self.mesh.cylinder_depth)

    @cached_property
    def spoke_angles(self) -> Float[np.ndarray, " spoke"]:
        """Angle of each spoke, counter-clockwise from east, at heading 0 [rad]."""
        return _read_only(_graph.spoke_angles(self.mesh, np.array(self.bridles.bearings)))

    @cached_property
    def sectors(self) -> Float[np.ndarray, " spoke"]:
        """Angle from each spoke to the next [rad]."""
        return _read_only(np.diff(self.spoke_angles, append=self.spoke_angles[0] + 2.0 * np.pi))

    @cached_property
    def spoke_share(self) -> Float[np.ndarray, " spoke"]:
        """Share of the round that each spoke stands for [-]."""
        return _read_only((self.sectors + np.roll(self.sectors, 1)) / (4.0 * np.pi))

    @cached_property
    def design_position(self) -> Float[np.ndarray, "node 3"]:
        """The shape the net was cut to [m]; the rest shape hangs a little narrower."""
        of = {"radius": self.collar.radius, "heading": self.heading}
        return _read_only(_graph.node_positions(self.mesh, self.spoke_angles, **of))

    @cached_property
    def edges(self) -> Int[np.ndarray, "edge 2"]:
        """Pairs of neighbouring nodes: rings, meridians, apex."""
        return _read_only(_graph.edges(self.rings, self.spokes))

    @cached_property
    def panels(self) -> Int[np.ndarray, "panel 4"]:
        """Corners of each panel, counter-clockwise from outside; triangles repeat the last."""
        return _read_only(_graph.panels(self.rings, self.spokes))

    def volume(self, node_position: _graph.Shapes) -> _graph.PerCase:
        """Volume that a shape of the net encloses, closed by the collar's polygon [m3]."""
        return _graph.enclosed_volume(node_position, self.panels, self.ring_nodes(0))

    def nearest(self, point: Point3, node_position: Node3) -> Nearest:
        """Nearest place to each point on a shape of the net [m]."""
        return nearest_on_net(point, node_position, self.panels)

    @property
    def plane(self) -> TangentPlane:
        """Latitude and longitude of the cage; refused where its file does not say."""
        if self.site.latitude is None or self.site.longitude is None:
            raise InputError(
                f"Cage {self.name}: its file does not say where it lies. Add latitude_deg and "
                "longitude_deg of its centre to [site]."
            )
        return TangentPlane(latitude=self.site.latitude, longitude=self.site.longitude)

    # Mooring

    @property
    def bridle_count(self) -> int:
        """Number of bridles."""
        return len(self.bridles.bearings)

    @property
    def bridle_names(self) -> tuple[str, ...]:
        """bridle-1, bridle-2, …: counter-clockwise from east."""
        return tuple(f"bridle-{number + 1}" for number in range(self.bridle_count))

    @cached_property
    def bridle_nodes(self) -> Int[np.ndarray, " bridle"]:
        """The collar node that each bridle holds."""
        return _read_only(np.array([self._nearest_spoke(b) for b in self.bridles.bearings]))

    @property
    def warnings(self) -> tuple[str, ...]:
        """Differences from the file: bridles that were moved to the nearest spoke."""
        held = (90.0 - np.rad2deg(self.spoke_angles[self.bridle_nodes])) % 360.0
        bridles = zip(self.bridle_names, self.bridles.bearings, held.tolist(), strict=True)
        moved = [
            f"{name} from {bearing:g}° to {now:g}°"
            for name, bearing, now in bridles
            if abs((now - bearing + 180.0) % 360.0 - 180.0) > _graph.SNAPPED
        ]
        warning = (
            f"Cage {self.name}: bridles are held at the nearest of {self.spokes} spokes, which "
            f"moves {', '.join(moved)}. Their loads are those of the moved bridles. Give the mesh "
            "more spokes: each can be moved to one bridle."
        )
        return (warning,) if moved else ()

    @cached_property
    def corner_position(self) -> Float[np.ndarray, "corner 3"]:
        """Frame corners in still water, a square's from north-east counter-clockwise [m]."""
        east, north = self.frame.corners.T
        bearing = np.rad2deg(np.arctan2(east, north)) + self.heading
        horizontal = towards(np.hypot(east, north), bearing)
        return _read_only(np.column_stack([horizontal, np.full(len(east), -self.frame.depth)]))

    @cached_property
    def bridle_corner(self) -> Int[np.ndarray, " bridle"]:
        """The frame corner that each bridle comes from: the nearest that it leaves outwards."""
        ends = self.design_position[self.bridle_nodes]
        line = self.corner_position - ends[:, None]
        outwards = np.einsum("bcx,bx->bc", line[..., :2], ends[:, :2]) > 0.0
        # where two are equally near, rounding must not choose
        distance = np.where(outwards, np.linalg.norm(line, axis=-1).round(6), np.inf)
        return _read_only(np.argmin(distance, axis=1))

    @property
    def bridle_capacity(self) -> Float[np.ndarray, " bridle"]:
        """Breaking load over material factor [N]."""
        return np.full(self.bridle_count, self.bridles.breaking_load / self.bridles.material_factor)

    # Sensors

    @cached_property
    def shackles(self) -> tuple[Shackle, ...]:
        """The load shackles."""
        return tuple(Shackle(name=entry.name, bridle=entry.bridle - 1) for entry in self.shackle)

    @cached_property
    def depth_sensors(self) -> tuple[DepthSensor, ...]:
        """The depth sensors, each on the node nearest to its place."""
        return tuple(
            DepthSensor(name=entry.name, node=self._nearest_node(entry))
            for entry in self.depth_sensor
        )

    @property
    def sensor_names(self) -> tuple[str, ...]:
        """Streams of the depth sensors, then of the shackles."""
        return tuple(entry.name for entry in (*self.depth_sensor, *self.shackle))

    def _nearest_spoke(self, bearing: float) -> int:
        angles = np.rad2deg(np.append(self.spoke_angles, self.spoke_angles[0] + 2.0 * np.pi))
        at = (90.0 - bearing - angles[0]) % 360.0 + angles[0]
        # halfway between two spokes rounding must not decide
        return round(round(float(np.interp(at, angles, np.arange(len(angles)))), 6)) % self.spokes

    def _nearest_node(self, entry: _parts.DepthSensorEntry) -> int:
        depths = np.array([*self.mesh.ring_depths, self.mesh.tip_depth])
        ring = int(np.argmin(np.abs(depths - entry.depth)))
        if ring == self.rings:
            return self.bottom_node
        return self.node(ring, self._nearest_spoke(entry.bearing))


def _read_only(array: np.ndarray) -> np.ndarray:
    """An array that nobody can write into, for it is handed out more than once."""
    array.setflags(write=False)
    return array
