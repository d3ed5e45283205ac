"""Messages of ROS 2 in an MCAP file, written without any ROS."""

import tempfile
from collections.abc import Mapping, Sequence
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import InputError, SeacageError

FRAME_ID = "seacage_enu"  # of all messages: metres east, north and up of the cage's centre
TRIANGLE_LIST = 11
_POINT_FLOAT, _FIELDS = 7, ("x", "y", "z", "sigma")
_LAST_NS = 2**31 * 10**9
_COLOUR = {"r": 0.2, "g": 0.6, "b": 0.8, "a": 0.5}
Points = Float[np.ndarray, "point 3"]


class NoRosbagsError(SeacageError):
    """The package that writes MCAP is not installed."""


class RosMessages:
    """Messages of one time, in the types of ROS 2.

    Raises NoRosbagsError: the package that writes them is not installed.
    Raises InputError: ROS has no such time.
    """

    def __init__(self, t: datetime) -> None:
        try:
            from rosbags.typesys import Stores, get_typestore
        except ImportError as error:
            raise NoRosbagsError(
                "MCAP is written by rosbags, which is not installed. Install seacage[ros]."
            ) from error
        self._store: Any = get_typestore(Stores.ROS2_JAZZY)
        self._ns = round(t.timestamp() * 1e6) * 1000
        if not 0 <= self._ns < _LAST_NS:
            raise InputError(f"ROS tells time from 1970 to 2038, and this is {t.isoformat()}.")

    def cloud(self, position: Points, sigma: Float[np.ndarray, " point"]) -> Any:
        """Nodes with their sigma."""
        values = np.column_stack([position, sigma])
        packed = np.ascontiguousarray(values, dtype="<f4").view(np.uint8).ravel()
        about = {"datatype": _POINT_FLOAT, "count": 1}
        field = partial(self._message, "sensor_msgs/msg/PointField", **about)
        return self._message(
            "sensor_msgs/msg/PointCloud2",
            header=self._header(),
            height=1,
            width=len(position),
            fields=[field(name=name, offset=4 * k) for k, name in enumerate(_FIELDS)],
            is_bigendian=False,
            point_step=16,
            row_step=16 * len(position),
            data=packed,
            is_dense=True,
        )

    def mesh(self, position: Points, triangles: Int[np.ndarray, "triangle 3"]) -> Any:
        """Triangles, counter-clockwise seen from outside the net."""
        corners = position[triangles].reshape(-1, 3)
        return self._message(
            "visualization_msgs/msg/Marker",
            header=self._header(),
            ns="net",
            type=TRIANGLE_LIST,
            pose=self._pose(np.zeros(3), np.array([1.0, 0.0, 0.0])),
            scale=self._message("geometry_msgs/msg/Vector3", x=1.0, y=1.0, z=1.0),
            color=self._message("std_msgs/msg/ColorRGBA", **_COLOUR),
            points=[self._point(one) for one in corners],
        )

    def path(self, position: Points, facing: Points) -> Any:
        """Poses whose x axis looks along a direction."""
        poses = [
            self._message(
                "geometry_msgs/msg/PoseStamped", header=self._header(), pose=self._pose(at, along)
            )
            for at, along in zip(position, facing, strict=True)
        ]
        return self._message("nav_msgs/msg/Path", header=self._header(), poses=poses)

    def write(self, messages: Mapping[str, Any]) -> bytes:
        """Return the MCAP file that holds these messages by topic."""
        from rosbags.rosbag2 import StoragePlugin, Writer

        with tempfile.TemporaryDirectory() as name:
            bag = Path(name) / "bag"
            with Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
                for topic, message in messages.items():
                    kind = message.__msgtype__
                    connection = writer.add_connection(topic, kind, typestore=self._store)
                    writer.write(connection, self._ns, self._store.serialize_cdr(message, kind))
            (file,) = bag.glob("*.mcap")
            return file.read_bytes()

    def _message(self, kind: str, **values: Any) -> Any:
        """A message; what is not given is empty, as ROS has it."""
        empty = {name: self._nothing(*what) for name, what in self._store.fielddefs[kind][1]}
        return self._store.types[kind](**{**empty, **values})

    def _nothing(self, node: Any, what: Any) -> Any:
        from rosbags.interfaces import Nodetype

        if node == Nodetype.NAME:
            return self._message(what)
        if node == Nodetype.BASE:
            kind = what[0]
            return "" if kind == "string" else False if kind == "bool" else 0
        (inside, kind), _ = what
        return np.zeros(0, dtype=kind[0]) if inside == Nodetype.BASE else []

    def _header(self) -> Any:
        seconds, rest = divmod(self._ns, 10**9)
        stamp = self._message("builtin_interfaces/msg/Time", sec=seconds, nanosec=rest)
        return self._message("std_msgs/msg/Header", stamp=stamp, frame_id=FRAME_ID)

    def _point(self, at: Float[np.ndarray, " 3"]) -> Any:
        x, y, z = at.tolist()
        return self._message("geometry_msgs/msg/Point", x=x, y=y, z=z)

    def _pose(self, at: Float[np.ndarray, " 3"], along: Float[np.ndarray, " 3"]) -> Any:
        x, y, z, w = _orientation_along(along)
        turn = self._message("geometry_msgs/msg/Quaternion", x=x, y=y, z=z, w=w)
        return self._message("geometry_msgs/msg/Pose", position=self._point(at), orientation=turn)


def _orientation_along(along: Float[np.ndarray, " 3"]) -> Sequence[float]:
    """Quaternion (x, y, z, w) that turns the x axis along a direction, without roll."""
    yaw = np.arctan2(along[1], along[0]) / 2.0
    pitch = -np.arctan2(along[2], np.hypot(along[0], along[1])) / 2.0
    return (
        float(-np.sin(yaw) * np.sin(pitch)),
        float(np.cos(yaw) * np.sin(pitch)),
        float(np.sin(yaw) * np.cos(pitch)),
        float(np.cos(yaw) * np.cos(pitch)),
    )
