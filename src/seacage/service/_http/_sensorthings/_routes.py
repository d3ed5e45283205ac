"""What was measured, as OGC SensorThings: read only, and without what it does not do."""

import json
from collections.abc import Callable
from datetime import datetime
from typing import Annotated, Any
from urllib.parse import quote, urlencode

from fastapi import APIRouter, Depends, Path, Query, Request
from pydantic import BaseModel, ConfigDict, Field

from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._http._dependencies import READ, REFUSED, Responses, cages_of, may_read
from seacage.service._http._sensorthings._entities import (
    OBSERVATIONS,
    OBSERVED,
    RELATIONS,
    ROOT,
    SETS,
    Catalogue,
    Entity,
    leads_of,
    observation,
)
from seacage.service._http._sensorthings._query import (
    FARTHEST,
    MOST,
    QueryOptions,
    Span,
    filter_text,
    from_or_until,
    read_query,
)
from seacage.service._schemas._base import AbstractAnswer

_AT_ONCE = 30_000  # entities told and samples looked at, in one answer: expansions multiply
_TIMES = ("phenomenonTime", "resultTime")
_CONFORMS = "http://www.opengis.net/spec/iot_sensing/1.1/req/"
_KEPT = ("datamodel", *(f"request-data/{one}" for one in ("select", "expand", "top", "skip")))
_PLAIN = ":/'()@"  # of a path: what it may hold as it is
things = APIRouter(prefix=ROOT, tags=["SensorThings"], dependencies=may_read)
Id = Annotated[str, Path(max_length=200, examples=["ace:buoy-1:current_speed_m_s"])]
_ADDRESS = f"http://127.0.0.1:8000{ROOT}"
_ENTITY: Entity = {
    "@iot.id": "ace",
    "@iot.selfLink": f"{_ADDRESS}/Things('ace')",
    "name": "ace",
    "description": "Net cage ace.",
    "properties": {},
}


def _one_of(name: str) -> Responses:
    """Document the answer of a call that gives one entity."""
    entity = _ENTITY | {"@iot.selfLink": f"{_ADDRESS}/{name}('ace')"}
    return {**READ, 200: {"content": {"application/json": {"example": entity}}}}


class Entities(AbstractAnswer):
    """A set of entities, as SensorThings says it; the links and the count where they belong."""

    value: list[Entity]
    count: int = Field(default=0, alias="@iot.count")
    next_link: str = Field(default="", alias="@iot.nextLink")


class Root(AbstractAnswer):
    """The sets there are, and what of the standard is kept."""

    value: list[dict[str, str]]
    serverSettings: dict[str, Any]  # noqa: N815 (the standard's word)


class _OptionsOfOne(BaseModel):
    model_config = ConfigDict(alias_generator="${}".format)

    select: str | None = Field(
        None, max_length=300, description="Only these.", examples=["name,id"]
    )
    expand: str | None = Field(
        None,
        max_length=500,
        description="Tell relations in full, each with options of its own in brackets.",
        examples=["Datastreams($expand=Observations($top=1;$orderby=phenomenonTime desc))"],
    )


class _AllOptions(_OptionsOfOne):
    top: int = Field(100, ge=1, le=MOST, description="At most so many.")
    skip: int = Field(0, ge=0, le=FARTHEST, description="Leave out the first.")
    count: bool = Field(default=False, description="Say how many there are in all.")
    orderby: str | None = Field(
        None,
        max_length=60,
        description="One property, asc or desc; of Observations their time.",
        examples=["name desc"],
    )
    filter: str | None = Field(
        None,
        max_length=300,
        description="Of Observations alone: by phenomenonTime or resultTime, terms joined by and.",
        examples=["resultTime ge 2018-01-26T00:00:00Z and resultTime lt 2018-01-27T00:00:00Z"],
    )


def _read_all(request: Request, given: Annotated[_AllOptions, Query()]) -> QueryOptions:
    return _read_of_one(request, given)


def _read_of_one(request: Request, given: Annotated[_OptionsOfOne, Query()]) -> QueryOptions:
    texts = {
        name: one if isinstance(one, str) else json.dumps(one)
        for name, one in given.model_dump(by_alias=True, exclude_none=True).items()
    }
    foreign = [name for name in request.query_params if name.startswith("$") and name not in texts]
    if foreign:
        raise InputError(f"{foreign[0]} is not offered here.")
    return read_query(texts)


Listing = Annotated[QueryOptions, Depends(_read_all)]
Telling = Annotated[QueryOptions, Depends(_read_of_one)]


class _Answer:
    """Tells entities as they were asked for, of those that the token may read."""

    def __init__(self, request: Request) -> None:
        address = str(request.base_url).rstrip("/")
        self.catalogue = Catalogue(cages=cages_of(request), address=address)
        self._left = _AT_ONCE

    def page(self, of: str, found: list[Entity], query: QueryOptions, address: str) -> Entity:
        """Tell some of the entities that were found, and where the rest is."""
        if query.within is not None:
            raise InputError("$filter: only Observations can be filtered, by their time.")
        ordered = _order(of, found, query)
        rest = query.skip + query.top
        body: Entity = {"value": [self.one(of, one, query) for one in ordered[query.skip : rest]]}
        if query.count:
            body["@iot.count"] = len(found)
        if rest < len(found):
            body["@iot.nextLink"] = _address(address, {**query.texts, "$skip": str(rest)})
        return body

    def one(self, of: str, entity: Entity, query: QueryOptions) -> Entity:
        """Tell an entity with what is selected of it and what it is expanded by."""
        self._spend(1)
        body = _select(of, entity, query)
        for name, inner in query.expand.items():
            entities = self._expand(of, entity, name, inner)
            body.pop(f"{name}@iot.navigationLink", None)
            body |= entities
        return body

    def observations(self, stream: Entity, query: QueryOptions) -> Entity:
        """Tell readings of a Datastream's quantity in the order of their times."""
        datastream, address = stream["@iot.id"], f"{stream['@iot.selfLink']}/{OBSERVATIONS}"
        if query.expand:
            raise InputError("$expand: Observations lead to nothing more.")
        _select(OBSERVATIONS, dict.fromkeys(OBSERVED), query)  # refused where there are none too
        newest = _newest_first(query)
        span, reach = query.within or (None, None), query.skip + query.top
        read = self._samples(datastream, span, limit=reach + 1, newest=newest)
        entities = self._observations(datastream, read[query.skip : reach])
        body: Entity = {"value": [_select(OBSERVATIONS, one, query) for one in entities]}
        if query.count:
            body["@iot.count"] = self._count(datastream, span)
        if len(read) > reach:
            body["@iot.nextLink"] = _address(address, _onward(query, read[:reach], newest=newest))
        return body

    def follow(self, of: str, entity: Entity, name: str, query: QueryOptions) -> Entity:
        """Tell what a relation of an entity leads to: a page of entities, or the one there is."""
        found = self.catalogue.list_related(of, entity["@iot.id"], name)
        if name in SETS:
            return self.page(name, found, query, f"{entity['@iot.selfLink']}/{name}")
        return self.one(RELATIONS[of][name], found[0], query)

    def _expand(self, of: str, entity: Entity, name: str, query: QueryOptions) -> Entity:
        if (of, name) == ("Datastreams", OBSERVATIONS):
            page = self.observations(entity, query)
        elif name not in RELATIONS[of]:
            there = ", ".join(leads_of(of))
            raise InputError(f"$expand: {of} lead to no {name!r}. There are {there}.")
        else:
            page = self.follow(of, entity, name, query)
            if name not in SETS:
                return {name: page}
        value = page.pop("value")
        return {name: value} | {f"{name}{key}": one for key, one in page.items()}

    def _count(self, datastream: str, span: Span) -> int:
        read = self._samples(datastream, span, limit=FARTHEST + 1, newest=False)
        if len(read) > FARTHEST:
            raise InputError(
                f"$count: there are more than {FARTHEST} samples. Name a shorter time by $filter."
            )
        return len(self._observations(datastream, read))

    def _samples(self, datastream: str, span: Span, *, limit: int, newest: bool) -> list[Sample]:
        """Read a stream's samples in the order that is asked for."""
        cage, stream, _ = datastream.split(":")
        read = self.catalogue.cages[cage].store.samples(
            cage, stream=stream, start=span[0], end=span[1], limit=limit, newest=newest
        )
        self._spend(len(read))
        return read[::-1] if newest else read

    def _spend(self, parts: int) -> None:
        self._left -= parts
        if self._left < 0:
            raise InputError(
                f"One question may look at {_AT_ONCE} entities and samples. Give a smaller $top "
                "or $skip, or expand less."
            )

    def _observations(self, datastream: str, samples: list[Sample]) -> list[Entity]:
        key = datastream.rpartition(":")[2]
        return [observation(datastream, one) for one in samples if key in one.values]


@things.get("", responses=REFUSED)
async def get_root() -> Root:
    """Name the sets, and what of the standard is kept: its data, to be read.

    Observations are found by their Datastream alone, are filtered and ordered by their time, and
    have no FeatureOfInterest. There is no writing.
    """
    return Root(
        value=[{"name": name, "url": f"{ROOT}/{name}"} for name in SETS],
        serverSettings={"conformance": [f"{_CONFORMS}{one}" for one in _KEPT]},
    )


Answering = Annotated[_Answer, Depends()]


def _list_call(name: str) -> Callable[..., Entity]:
    def list_all(answer: Answering, options: Listing) -> Entity:
        catalogue = answer.catalogue
        address = f"{catalogue.address}{ROOT}/{name}"
        return answer.page(name, catalogue.all(name), options, address)

    list_all.__doc__ = f"List the {name} of all cages that the token may read."
    return list_all


def _single(name: str) -> Callable[..., Entity]:
    def single(answer: Answering, id: Id, options: Telling) -> Entity:  # noqa: A002
        return answer.one(name, answer.catalogue.one(name, id), options)

    single.__doc__ = f"Say one of the {name}."
    return single


def _leading(name: str, relation: str) -> Callable[..., Entity]:
    def many(answer: Answering, id: Id, options: Listing) -> Entity:  # noqa: A002
        return answer.follow(name, answer.catalogue.one(name, id), relation, options)

    def single(answer: Answering, id: Id, options: Telling) -> Entity:  # noqa: A002
        return answer.follow(name, answer.catalogue.one(name, id), relation, options)

    leading = many if relation in SETS else single
    leading.__doc__ = f"Say what one of the {name} leads to as its {relation}."
    return leading


_PAGED: dict[str, Any] = {"response_model": Entities, "response_model_exclude_unset": True}

for _name in SETS:
    things.get(f"/{_name}", responses=REFUSED, operation_id=f"sta_{_name}", **_PAGED)(
        _list_call(_name)
    )
    things.get(f"/{_name}('{{id}}')", responses=_one_of(_name), operation_id=f"sta_one_of_{_name}")(
        _single(_name)
    )
    for _relation in RELATIONS[_name]:
        things.get(
            f"/{_name}('{{id}}')/{_relation}",
            responses=READ if _relation in SETS else _one_of(_name),
            operation_id=f"sta_{_relation}_of_{_name}",
            **(_PAGED if _relation in SETS else {}),
        )(_leading(_name, _relation))


@things.get("/Datastreams('{id}')/Observations", responses=READ, **_PAGED)
def get_observations(answer: Answering, id: Id, options: Listing) -> Entity:  # noqa: A002
    """Give stored readings of one quantity, raw, with their flags; null where there was none.

    ``$skip`` and ``$top`` count the stream's samples, of which some may lack the quantity.
    """
    return answer.observations(answer.catalogue.one("Datastreams", id), options)


def _order(of: str, found: list[Entity], query: QueryOptions) -> list[Entity]:
    if query.order is None:
        return found
    name, descending = query.order
    key = _property(name)
    if any(not isinstance(one.get(key), str) for one in found):
        raise InputError(f"$orderby: {of} are ordered by a property that is text, not {name!r}.")
    return sorted(found, key=lambda one: one[key], reverse=descending)


def _newest_first(query: QueryOptions) -> bool:
    name, descending = query.order or (_TIMES[0], False)
    if name not in _TIMES:
        raise InputError(f"$orderby: Observations are ordered by {' or '.join(_TIMES)}.")
    return descending


def _select(of: str, entity: Entity, query: QueryOptions) -> Entity:
    if not query.select:
        return dict(entity)
    wanted = {_property(name) for name in query.select}
    names = wanted | {f"{name}@iot.navigationLink" for name in wanted}
    body = {name: one for name, one in entity.items() if name in names}
    strange = wanted - body.keys() - {name.partition("@")[0] for name in body}
    if strange:
        raise InputError(f"$select: {of} have no {min(strange)!r}.")
    return body


def _property(name: str) -> str:
    return f"@iot.{name}" if name in {"id", "selfLink"} else name


def _onward(query: QueryOptions, read: list[Sample], *, newest: bool) -> dict[str, str]:
    """Ask on from the time of the last that was read: so a page far on costs no more than another.

    Of several samples of that time those that were read are left out.
    """
    last: datetime = read[-1].t
    span = from_or_until(query.within or (None, None), last, newest=newest)
    known = sum(one.t == last for one in read)
    return {**query.texts, "$filter": filter_text(span), "$skip": str(known)}


def _address(path: str, texts: dict[str, str]) -> str:
    usual = {"$skip": "0", "$count": "false"}
    kept = {name: text for name, text in texts.items() if usual.get(name) != text}
    return f"{quote(path, safe=_PLAIN)}?{urlencode(kept, safe='$(),=;:/', quote_via=quote)}"
