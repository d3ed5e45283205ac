"""What was measured, as OGC SensorThings: read only, and without what it does not do."""

import re
from collections.abc import Callable, Iterator, Mapping
from datetime import datetime, timedelta
from typing import Annotated, Any

from fastapi import APIRouter, HTTPException, Path, Query, Request
from pydantic import BaseModel, TypeAdapter, ValidationError

from seacage.conventions import InputError
from seacage.records import KEYS, Sample
from seacage.service._access._guard import gate_of
from seacage.service._calls._calls import READ, REFUSED, may_read
from seacage.service._forms._schemas import Reach
from seacage.service._live._cage import LiveCage

_ROOT = "/sta/v1.1"
_UNDEFINED = "http://www.opengis.net/def/nil/OGC/0/unknown"
_TYPE = "http://www.opengis.net/def/observationType/OGC-OM/2.0/OM_Measurement"
_CONFORMS = "http://www.opengis.net/spec/iot_sensing/1.1/req/datamodel"
_TERM = re.compile(r"(resultTime|phenomenonTime) (eq|ge|gt|le|lt) (\S+)")
_TICK = timedelta(microseconds=1)

Entity = dict[str, Any]

things = APIRouter(prefix=_ROOT, tags=["SensorThings"], dependencies=may_read)

Top = Annotated[int, Query(alias="$top", ge=1, le=1000, description="At most so many.")]
Skip = Annotated[int, Query(alias="$skip", ge=0, le=10_000, description="Leave out the first.")]
Filter = Annotated[
    str | None,
    Query(
        alias="$filter",
        max_length=300,
        description="By resultTime or phenomenonTime, terms joined by and.",
        examples=["resultTime ge 2018-01-26T00:00:00Z and resultTime lt 2018-01-27T00:00:00Z"],
    ),
]
_ORDER = r"^(resultTime|phenomenonTime)( asc| desc)?$"
Order = Annotated[str, Query(alias="$orderby", pattern=_ORDER, max_length=30)]
Id = Annotated[str, Path(max_length=200, examples=["ace:buoy-1:current_speed_m_s"])]


class Entities(BaseModel):
    """A set of entities, as SensorThings says it."""

    value: list[Entity]


class Root(BaseModel):
    """The sets there are, and what of the standard is kept."""

    value: list[dict[str, str]]
    serverSettings: dict[str, Any]  # noqa: N815 (the standard's word)


def _things(cages: Mapping[str, LiveCage]) -> Iterator[Entity]:
    for name in cages:
        yield _entity("Things", name, name=name, description=f"Net cage {name}.", properties={})


def _locations(cages: Mapping[str, LiveCage]) -> Iterator[Entity]:
    for name, live in cages.items():
        site = live.twin.cage.site
        if site.latitude is not None and site.longitude is not None:
            yield _entity(
                "Locations",
                name,
                name=name,
                description=f"Centre of cage {name}.",
                encodingType="application/geo+json",
                location={"type": "Point", "coordinates": [site.longitude, site.latitude]},
            )


def _sensors(cages: Mapping[str, LiveCage]) -> Iterator[Entity]:
    for name, live in cages.items():
        for stream in live.streams:
            yield _entity(
                "Sensors",
                f"{name}:{stream}",
                name=stream,
                description=f"The stream {stream} of cage {name}.",
                encodingType="text/plain",
                metadata=f"Origin: {live.twin.origin}",
            )


def _properties(cages: Mapping[str, LiveCage]) -> Iterator[Entity]:
    carried = {key for live in cages.values() for keys in live.streams.values() for key in keys}
    for key in sorted(carried):
        yield _entity(
            "ObservedProperties",
            key,
            name=key,
            description=KEYS[key].long_name,
            definition=_UNDEFINED,
        )


def _datastreams(cages: Mapping[str, LiveCage]) -> Iterator[Entity]:
    for name, live in cages.items():
        for stream, keys in live.streams.items():
            for key in keys:
                unit = KEYS[key].cf_unit
                yield _entity(
                    "Datastreams",
                    f"{name}:{stream}:{key}",
                    name=f"{key} of {stream}",
                    description=f"{KEYS[key].long_name}, read by {stream} of cage {name}.",
                    observationType=_TYPE,
                    unitOfMeasurement={"name": unit, "symbol": unit, "definition": _UNDEFINED},
                ) | _links(
                    Thing=f"Things('{name}')",
                    Sensor=f"Sensors('{name}:{stream}')",
                    ObservedProperty=f"ObservedProperties('{key}')",
                    Observations=f"Datastreams('{name}:{stream}:{key}')/Observations",
                )


_SETS: Mapping[str, Callable[[Mapping[str, LiveCage]], Iterator[Entity]]] = {
    "Things": _things,
    "Locations": _locations,
    "Sensors": _sensors,
    "ObservedProperties": _properties,
    "Datastreams": _datastreams,
}


@things.get("", responses=REFUSED)
async def get_root() -> Root:
    """Name the sets, and the one class of the standard that is kept.

    There is the data model, to be read. There are no links between all entities, no $expand,
    no $select, and no writing. Observations are found by their Datastream alone.
    """
    return Root(
        value=[{"name": name, "url": f"{_ROOT}/{name}"} for name in _SETS],
        serverSettings={"conformance": [_CONFORMS]},
    )


def _listed(name: str) -> Callable[..., Entities]:
    def listed(request: Request, top: Top = 100, skip: Skip = 0) -> Entities:
        found = list(_SETS[name](_readable(request)))
        return Entities(value=found[skip : skip + top])

    listed.__doc__ = f"List the {name} of all cages that the token may read."
    return listed


def _single(name: str) -> Callable[..., Entity]:
    def single(request: Request, id: Id) -> Entity:  # noqa: A002
        return _found(name, id, _readable(request))

    single.__doc__ = f"Say one of the {name}."
    return single


for _name in _SETS:
    things.get(f"/{_name}", responses=REFUSED, operation_id=f"sta_{_name}")(_listed(_name))
    things.get(f"/{_name}('{{id}}')", responses=READ, operation_id=f"sta_one_of_{_name}")(
        _single(_name)
    )


@things.get("/Datastreams('{id}')/Observations", responses=READ)
def get_observations(
    request: Request,
    id: Id,  # noqa: A002
    top: Top = 100,
    skip: Skip = 0,
    within: Filter = None,
    order: Order = "resultTime asc",
) -> Entities:
    """Give stored readings of one quantity, raw, with their flags; null where there was none.

    ``$skip`` and ``$top`` count the stream's samples, of which some may lack the quantity.
    """
    cages = _readable(request)
    _found("Datastreams", id, cages)
    name, stream, key = id.split(":")
    start, end = _span(within)
    samples = cages[name].store.samples(
        name,
        stream=stream,
        start=start,
        end=end,
        limit=skip + top,
        newest=(newest := order.endswith("desc")),
    )
    ordered = samples[::-1] if newest else samples
    return Entities(value=[_observed(id, key, one) for one in ordered[skip:] if key in one.values])


def _readable(request: Request) -> dict[str, LiveCage]:
    """The cages that the token may read; the guard knew it a moment ago."""
    gate, cages = gate_of(request), request.app.state.service.cages
    grant = request.state.grant
    return {n: one for n, one in cages.items() if grant.allows("read", n, site=gate.site)}


def _found(name: str, id: str, cages: Mapping[str, LiveCage]) -> Entity:  # noqa: A002
    for entity in _SETS[name](cages):
        if entity["@iot.id"] == id:
            return entity
    raise HTTPException(404, f"No {name} are called {id!r}.")


def _entity(of: str, id: str, **said: object) -> Entity:  # noqa: A002
    return {"@iot.id": id, "@iot.selfLink": f"{_ROOT}/{of}('{id}')", **said}


def _links(**to: str) -> Entity:
    return {f"{name}@iot.navigationLink": f"{_ROOT}/{path}" for name, path in to.items()}


def _observed(datastream: str, key: str, sample: Sample) -> Entity:
    t, value = sample.t.isoformat().replace("+00:00", "Z"), sample.values[key]
    number = "" if sample.seq is None else f".{sample.seq}"
    return {
        "@iot.id": f"{datastream}@{t}{number}",
        "phenomenonTime": t,
        "resultTime": t,
        "result": value if abs(value) < float("inf") else None,
        "resultQuality": int(sample.flags[key]),
    }


def _span(within: str | None) -> tuple[datetime | None, datetime | None]:
    start, end = None, None
    for term in within.split(" and ") if within else ():
        match = _TERM.fullmatch(term.strip())
        if match is None:
            raise InputError(
                f"$filter: {term.strip()!r} is not understood. Write e.g. resultTime ge "
                "2018-01-26T00:00:00Z, terms joined by and."
            )
        t, how = _time(match[3]), match[2]
        if how in {"eq", "ge", "gt"}:
            low = t + _TICK if how == "gt" else t
            start = low if start is None else max(start, low)
        if how in {"eq", "le", "lt"}:
            high = t if how == "lt" else t + _TICK
            end = high if end is None else min(end, high)
    return start, end


def _time(text: str) -> datetime:
    try:
        return TypeAdapter(Reach).validate_python(text)
    except ValidationError as error:
        raise InputError(f"$filter: {text!r} is no time with its zone.") from error
