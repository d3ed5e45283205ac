"""Campaigns as records: read from their stores, exported to NetCDF."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.conventions import Origin, RecordError, has_answer
from seacage.ocean import SeaState
from seacage.records._brief import brief
from seacage.records._campaign_store import (
    MEAN,
    NOT_RUN,
    SEA,
    SHEAR,
    SPREAD,
    campaign_unsummed,
    fill_campaign,
    not_a_campaign,
    sea_names,
)
from seacage.records._lines import LINES
from seacage.records._netcdf_file import check_netcdf, write_netcdf

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CampaignRecord:
    """One cage in many sea states, as a simulator answered them.

    What a campaign does not have is None: one of equilibria has no statistics over time, one
    in time no residual.
    """

    cage_toml: str  # the cage, as its file
    seas: tuple[SeaState, ...]  # the sea state of each case
    node_position: Float[np.ndarray, "case node 3"]  # mean positions; x east, y north, z up [m]
    bridle_tension: Float[np.ndarray, "case line"]  # mean tensions [N]
    net_force: Float[np.ndarray, "case 3"]  # load of the water on the netting [N]
    volume: Float[np.ndarray, " case"]  # inside the net [m3]
    residual: Float[np.ndarray, " case"] | None = None  # largest unbalanced force at a node [N]
    result: Int[np.ndarray, " case"]  # how each case ended, a ``Result``; diverged ones hold NaN
    law: str  # the load law of the netting
    seed: int  # of the plan that drew the sea states
    version: str  # of the seacage that computed the answers
    physics: int | None = None  # and its revision of the physics, where that is known
    wave_seed: Int[np.ndarray, " case"] | None = None  # of each case's waves
    # Of each case's mooring: ``Cage.drawn`` by it is the case's cage. None where all cases have the
    # cage's own mooring.
    mooring_seed: Int[np.ndarray, " case"] | None = None
    # Simulated time at which a case was given up, spin-up included; NaN for the others [s]
    diverged_at: Float[np.ndarray, " case"] | None = None
    quantile: Float[np.ndarray, " quantile"] | None = None  # probabilities of the quantiles [-]
    # Of the positions over time [m]
    node_position_std: Float[np.ndarray, "case node 3"] | None = None
    node_position_minimum: Float[np.ndarray, "case node 3"] | None = None
    node_position_maximum: Float[np.ndarray, "case node 3"] | None = None
    node_position_quantile: Float[np.ndarray, "case quantile node 3"] | None = None
    # Of the tensions over time [N]
    bridle_tension_std: Float[np.ndarray, "case line"] | None = None
    bridle_tension_minimum: Float[np.ndarray, "case line"] | None = None
    bridle_tension_maximum: Float[np.ndarray, "case line"] | None = None
    bridle_tension_quantile: Float[np.ndarray, "case quantile line"] | None = None
    # Of the load [N] and of the volume [m3] over time
    net_force_std: Float[np.ndarray, "case 3"] | None = None
    volume_std: Float[np.ndarray, " case"] | None = None
    # Mean over time and all cases to learn from of the products of all coordinates, as
    # displacements from the design shape: coordinate 3 n + a is axis a of node n [m2]
    second_moment: Float[np.ndarray, "coordinate coordinate"] | None = None
    duration: float = math.nan  # time that each case's statistics are over; NaN for equilibria [s]
    # All ropes and chains of the mooring, the bridles first; none where they were not kept
    line_names: tuple[str, ...] = ()
    line_kinds: tuple[str, ...] = ()
    # Their loads by the names of ``LINES``: case × line, ``capacity`` and ``tn_slope`` by line
    lines: Mapping[str, Float[np.ndarray, "*case_too mooring_line"]] = field(
        default_factory=dict[str, np.ndarray]
    )
    parted: tuple[str, ...] = ()  # those that bore nothing, as they had parted
    simulator: str | None = None  # another program whose results these are; None: seacage's own

    origin: ClassVar[Origin] = Origin.COMPUTED  # a campaign is always computed
    __repr__ = brief

    def __len__(self) -> int:
        return len(self.seas)

    @property
    def converged(self) -> Bool[np.ndarray, " case"]:
        """The cases to learn from: those that ended with an answer."""
        return has_answer(self.result)

    @property
    def sha256(self) -> str:
        """Hash of the cage, the sea states and the answers, for what learns from them."""
        digest = hashlib.sha256(self.cage_toml.encode())
        for part in fields(self):
            value = getattr(self, part.name)
            apart = part.name in ("duration", "parted", "physics") or part.name.startswith("line")
            if value is None or apart:
                continue
            digest.update(
                value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode()
            )
        for name in sorted(self.lines):  # campaigns of 0.1.0 have none
            digest.update(self.lines[name].tobytes())
        if len(sea_names(self.seas)) > len(SEA):  # what their text leaves out
            digest.update(repr([(sea.current_shear, sea.shear_to) for sea in self.seas]).encode())
        digest.update(", ".join(self.parted).encode())
        return digest.hexdigest()


def read_campaign(path: str | Path) -> CampaignRecord:
    """A finished campaign from its Zarr store, or from the NetCDF file exported from it.

    Raises RecordError: no campaign is there, or some of its cases have not been run.
    """
    path = Path(path)
    with _open(path) as dataset:
        attributes, there = dict(dataset.attrs), {str(name) for name in dataset.variables}
        optional = (part.name for part in fields(CampaignRecord) if part.default is None)
        names = there.intersection((*SEA, *SHEAR, *MEAN, "result", *optional))
        variables = {name: np.asarray(dataset[name].values) for name in names}
        lines = {
            name: np.asarray(dataset[f"line_{name}"].values)
            for name in LINES
            if f"line_{name}" in there
        }
    missing = int(np.sum(variables["result"] == NOT_RUN))
    if missing:
        raise RecordError(
            f"{path}: {missing} of {len(variables['result'])} cases of this campaign have not "
            "been run. Run the campaign again; it goes on where it stopped."
        )
    if campaign_unsummed(path):
        raise RecordError(
            f"{path}: every case of this campaign has been run, but their second moment is not "
            "summed yet. Say `seacage campaign finish` with this folder."
        )
    of_seas = [name for name in (*SEA, *SHEAR) if name in variables]
    seas = zip(*(variables.pop(name).tolist() for name in of_seas), strict=True)
    return CampaignRecord(
        cage_toml=attributes["cage"],
        seas=tuple(SeaState(**dict(zip(of_seas, row, strict=True))) for row in seas),
        law=attributes["law"],
        seed=int(attributes["seed"]),
        version=attributes["product_version"],
        physics=int(attributes["physics"]) if "physics" in attributes else None,
        duration=float(attributes.get("duration_s", math.nan)),
        line_names=_words(attributes.get("line_names", "")),
        line_kinds=_words(attributes.get("line_kinds", "")),
        lines=lines,
        parted=_words(attributes.get("parted", "")),
        simulator=attributes.get("simulator"),
        **variables,
    )


def write_campaign(campaign: CampaignRecord, path: Path, **attributes: str) -> None:
    """Write a campaign of another simulator as a store that ``read_campaign`` reads.

    ``attributes``: of the store, such as its title.

    Raises RecordError: there is something at ``path``.
    """
    seas, names = campaign.seas, sea_names(campaign.seas)
    values: dict[str, object] = {name: [getattr(sea, name) for sea in seas] for name in names}
    values |= {name: getattr(campaign, name) for name in (*MEAN, "result", *SPREAD)}
    values |= {f"line_{name}": each for name, each in campaign.lines.items()}
    about = {"line_names": campaign.line_names, "line_kinds": campaign.line_kinds}
    fill_campaign(
        path,
        {name: np.asarray(each) for name, each in values.items() if each is not None},
        {
            "product_version": campaign.version,
            "origin": campaign.origin.value,
            "cage": campaign.cage_toml,
            "law": campaign.law,
            "simulator": campaign.simulator,
            "seed": campaign.seed,
            **({} if math.isnan(campaign.duration) else {"duration_s": campaign.duration}),
            **{name: ", ".join(words) for name, words in about.items()},
            **attributes,
        },
    )


def export_campaign(store: str | Path, path: str | Path) -> None:
    """Write a campaign's Zarr store as one CF-NetCDF file."""
    with _open(Path(store)) as dataset:
        for variable in dataset.variables.values():
            variable.encoding = {}  # Zarr's own, which NetCDF does not know
        result = dataset["result"]
        result.attrs["flag_values"] = np.array(result.attrs["flag_values"], result.dtype)
        write_netcdf(dataset, Path(path))


def _open(path: Path) -> "xarray.Dataset":
    import xarray

    try:
        if path.is_dir():
            dataset = xarray.open_dataset(path, engine="zarr", consolidated=False)
        else:
            check_netcdf(path, whole=True)
            dataset = xarray.open_dataset(path, engine="h5netcdf")
    except (OSError, KeyError, ValueError) as error:
        raise not_a_campaign(path) from error
    if not {*SEA, *MEAN, "result"} <= {str(name) for name in dataset.variables}:
        dataset.close()
        raise not_a_campaign(path)
    return dataset


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split(", ")) if text else ()
