"""A twin as settings that JSON can hold and arrays by name, and back."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from seacage import surrogates
from seacage.cage import Cage
from seacage.conventions import ModelError, Origin, SeacageError
from seacage.records import check_stream
from seacage.twin._correction import Correction, CurrentChange, Spread, WindowEdge, WindowErrors
from seacage.twin._discrepancy import Discrepancy
from seacage.twin._json_keys import json_keys
from seacage.twin._lines._line_correction import LineCorrection
from seacage.twin._lines._line_loads import LineLoads
from seacage.twin._lines._site_waves import SiteWaves
from seacage.twin._metocean import Input
from seacage.twin._models import Models
from seacage.twin._parted import PartedKind, PartedLines
from seacage.twin._profiles import Profiles
from seacage.twin._provenance import Provenance
from seacage.twin._settings import FaultDetectorSettings, StreamTimeouts
from seacage.twin._travel_time import TravelTime

FORMAT = "seacage twin"
VERSION = 2
# With what version 0.1.0 would ignore, a fault detector of other settings, a discrepancy of the
# net's level 2, a travel time of the current, its change, profiles of it, or edges of the training
# windows: it refuses these
TUNED_VERSION = 3

UPPER = "upper/"  # before the sensor's name, in the names of level 2's parts
PARTED = "parted/"  # before the line's name, in the names of what is left without it
PROFILES = "profiles:draws"
DISCREPANCY = "discrepancy:"  # before the names of the arrays of the shapes' errors
_ERRORS = ("current_velocity", "ring", "rest")
# Fields that the header has as they are
_OF_TWIN = ("provenance", "buoy", "timeouts", "fault_detector", "travel_time", "current_change")
_OF_PARTED = ("line", "learned", "simulated", "campaign_sha256")
_CHANGES = ("mean", "maximum", "state")  # processes of a ``LoadChange``
_OF_MODELS = ("inputs", "edge", "still_volume", "line_upper", "depth_ratio", "line_errors")
Kind = TypeVar("Kind", bound=surrogates.Fitted)
Box = tuple[tuple[float, ...], tuple[float, ...]]
"""Lower and upper ends of a domain."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PartedHeader:
    """All of a line that could part but its fitted processes."""

    line: str
    domain: Box
    learned: int
    simulated: int
    campaign_sha256: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Header:
    """All of a twin but its fitted models."""

    format: str
    version: int
    cage_toml: str
    inputs: tuple[Input, ...]
    domain: Box
    edge: tuple[float, float]
    still_volume: float
    gains: Mapping[str, float]
    spreads: Mapping[str, Spread]
    buoy: str
    timeouts: StreamTimeouts
    provenance: Provenance
    # Twins of 0.1.0 have none of these.
    fault_detector: FaultDetectorSettings = field(default_factory=FaultDetectorSettings)
    lines: tuple[tuple[str, str], ...] = ()
    line_domain: Box = ((), ())
    line_upper: Mapping[str, LineCorrection] = field(default_factory=dict[str, LineCorrection])
    depth_ratio: Mapping[str, surrogates.LoadRatio] = field(
        default_factory=dict[str, surrogates.LoadRatio]
    )
    line_errors: Mapping[str, WindowErrors] = field(default_factory=dict[str, WindowErrors])
    parted: tuple[PartedHeader, ...] = ()
    # Of level 2 against level 1, where that is not all
    weights: Mapping[str, float] = field(default_factory=dict[str, float])
    edges: Mapping[str, WindowEdge] = field(default_factory=dict[str, WindowEdge])
    line_waves: tuple[tuple[float, ...], ...] = ()
    line_waves_of: str = ""
    travel_time: TravelTime = field(default_factory=TravelTime)
    current_change: CurrentChange = field(default_factory=CurrentChange)

    __pydantic_config__ = json_keys(timeouts="watch")


def to_parts(
    *, models: Models, discrepancy: Discrepancy | None, **others: Any
) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Return a twin's settings and arrays, from its fields."""
    from pydantic import TypeAdapter

    usual = FaultDetectorSettings(), TravelTime(), CurrentChange()
    edges = {name: model.edge for name, model in models.upper.items() if model.edge.weight}
    tuned = tuple(others[name] for name in _OF_TWIN[-3:]) != usual or models.profiles or edges
    header = Header(
        format=FORMAT,
        version=TUNED_VERSION if tuned or (discrepancy and discrepancy.level > 1) else VERSION,
        cage_toml=models.cage.to_toml(),
        domain=_box(models.domain),
        **_of_loads(models.loads),
        parted=tuple(
            PartedHeader(
                domain=_box(one.domain), **{name: getattr(one, name) for name in _OF_PARTED}
            )
            for one in (models.parted.kinds if models.parted else ())
        ),
        gains={name: model.gain for name, model in models.upper.items()},
        weights={name: model.weight for name, model in models.upper.items()},
        spreads={name: model.spread for name, model in models.upper.items()},
        edges=edges,
        **{name: getattr(models, name) for name in _OF_MODELS},
        **others,
    )
    settings = TypeAdapter(Header).dump_python(header, mode="json", by_alias=True)
    parts: dict[str, surrogates.Fitted] = {"bridles": models.bridles, "shape": models.shape}
    if models.loads is not None:
        parts["loads"] = models.loads.surrogate
        if models.loads.motion is not None:
            parts["motion"] = models.loads.motion
    if models.parted is not None:
        parts |= {
            f"{PARTED}{one.line}/{name}": getattr(one.surrogate, name)
            for one in models.parted.kinds
            for name in _CHANGES
        }
    parts |= {f"{UPPER}{name}": model.rest for name, model in models.upper.items()}
    encoded = {name: surrogates.encode(part) for name, part in parts.items()}
    settings["models"] = {name: part for name, (part, _) in encoded.items()}
    arrays = {
        f"{name}:{key}": values
        for name, (_, arrays) in encoded.items()
        for key, values in arrays.items()
    }
    if models.parted is not None and models.parted.symmetry is not None:
        turns = models.parted.symmetry.to_arrays()
        arrays |= {f"{PARTED}:{key}": values for key, values in turns.items()}
    if models.profiles is not None:
        arrays[PROFILES] = models.profiles.draws
    if discrepancy is not None:
        settings["discrepancy"] = {"origin": str(discrepancy.origin), "level": discrepancy.level}
        arrays |= {f"{DISCREPANCY}{key}": getattr(discrepancy, key) for key in _ERRORS}
    return settings, arrays


def _of_loads(loads: LineLoads | None) -> dict[str, Any]:
    if loads is None:
        return {}
    lines = tuple(zip(loads.names, loads.kinds, strict=True))
    own = {"lines": lines, "line_domain": _box(loads.domain)}
    if loads.waves is None:
        return own
    rows = tuple(tuple(one) for one in loads.waves.table.tolist())
    return own | {"line_waves": rows, "line_waves_of": loads.waves.origin}


def _box(domain: surrogates.Domain) -> Box:
    return tuple(domain.lower.tolist()), tuple(domain.upper.tolist())


def _domain(box: Box) -> surrogates.Domain:
    return surrogates.Domain(lower=np.array(box[0]), upper=np.array(box[1]))


def from_parts(
    settings: Mapping[str, Any], arrays: Mapping[str, np.ndarray], *, source: str
) -> dict[str, Any]:
    """Return the fields of the twin that ``to_parts`` took apart.

    Raises ModelError: another format or version, or parts that do not fit together.
    """
    from pydantic import TypeAdapter

    known = settings.get("version") in (VERSION, TUNED_VERSION)
    if settings.get("format") != FORMAT or not known:
        raise ModelError(
            f"{source} is a {settings.get('format')!r} of version {settings.get('version')!r}; "
            f"this seacage reads {FORMAT!r} of versions {VERSION} and {TUNED_VERSION}. "
            "Train the twin anew."
        )
    try:
        # Strictly, as in JSON: a text such as "nan" is no number.
        header = TypeAdapter(Header).validate_json(json.dumps(settings), strict=True)
        check_stream(header.buoy)
        models = _models(header, settings["models"], arrays)
        discrepancy = _discrepancy(settings.get("discrepancy"), arrays, models.cage)
    except (KeyError, TypeError, ValueError, SeacageError) as error:
        raise ModelError(
            f"{source}: its parts do not fit together ({error}). Train the twin anew."
        ) from error
    others = {name: getattr(header, name) for name in _OF_TWIN}
    return {"models": models, "discrepancy": discrepancy, **others}


def _discrepancy(
    settings: Mapping[str, Any] | None, arrays: Mapping[str, np.ndarray], cage: Cage
) -> Discrepancy | None:
    if settings is None:
        return None
    own = {key: arrays[f"{DISCREPANCY}{key}"] for key in _ERRORS}
    cases = len(own["ring"])
    by_ring = cases, cage.rings + 1, 3
    for key, shape in zip(_ERRORS, ((cases, 2), by_ring, by_ring), strict=True):
        if own[key].shape != shape:
            raise ModelError(f"its {key} is {own[key].shape}, not {shape}.")
    # Before 0.2.0 nets had level 1 alone.
    level = settings.get("level", 1)
    if level not in (1, 2):
        raise ModelError(f"its discrepancy is of level {level!r}; there are 1 and 2.")
    return Discrepancy(origin=Origin(settings["origin"]), level=level, **own)


def _arrays_of(part: str, arrays: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    start = f"{part}:"
    return {key.removeprefix(start): each for key, each in arrays.items() if key.startswith(start)}


def _models(
    header: Header, settings: Mapping[str, Any], arrays: Mapping[str, np.ndarray]
) -> Models:
    def part(name: str, kind: type[Kind], **given: surrogates.Predicts) -> Kind:
        model = surrogates.decode(settings[name], _arrays_of(name, arrays), **given)
        if not isinstance(model, kind):
            raise ModelError(f"{name} is a {type(model).__name__}, not a {kind.__name__}.")
        return model

    gp, turns = surrogates.FittedGaussianProcess, _arrays_of(PARTED, arrays)
    models = Models(
        cage=Cage.from_toml(header.cage_toml),
        domain=_domain(header.domain),
        bridles=part("bridles", gp),
        shape=part("shape", surrogates.FittedShapeGP),
        loads=LineLoads(
            names=tuple(name for name, _ in header.lines),
            kinds=tuple(kind for _, kind in header.lines),
            surrogate=part("loads", surrogates.FittedLoadGP),
            motion=part("motion", surrogates.FittedMotionGP) if "motion" in settings else None,
            domain=_domain(header.line_domain),
            waves=SiteWaves(table=np.array(header.line_waves), origin=header.line_waves_of)
            if header.line_waves
            else None,
        )
        if header.lines
        else None,
        parted=PartedLines(
            kinds=tuple(
                PartedKind(
                    surrogate=surrogates.LoadChange(
                        **{name: part(f"{PARTED}{one.line}/{name}", gp) for name in _CHANGES}
                    ),
                    domain=_domain(one.domain),
                    **{name: getattr(one, name) for name in _OF_PARTED},
                )
                for one in header.parted
            ),
            symmetry=surrogates.Symmetry.from_arrays(turns, nodes=len(header.lines))
            if turns
            else None,
        )
        if header.parted
        else None,
        profiles=Profiles(draws=arrays[PROFILES]) if PROFILES in arrays else None,
        **{name: getattr(header, name) for name in _OF_MODELS},
    )
    for sensor, gain in header.gains.items():
        rest = part(f"{UPPER}{sensor}", surrogates.FittedNARGP, lower=models.lower(sensor))
        model = Correction(
            gain=gain,
            weight=header.weights.get(sensor, 1.0),
            rest=rest,
            spread=header.spreads[sensor],
            edge=header.edges.get(sensor, WindowEdge()),
        )
        models = models.with_level_2(sensor, model)
    return models
