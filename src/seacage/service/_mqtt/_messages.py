"""What travels by MQTT: samples in, acknowledgements, states and alarms out."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Annotated

from pydantic import Field, TypeAdapter, ValidationError

from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._schemas._base import AbstractRequest, Time
from seacage.service._schemas._samples import BATCH_LIMIT, SampleIn, read_samples

LARGEST = 1 << 18  # of a message [bytes]; a longer one is not read


class _Settled(AbstractRequest):
    t: Annotated[Time, Field(strict=False)]
    seq: int | None = None
    rejected: str | None = None
    retry: bool = False


class _Observed(AbstractRequest):
    t: Annotated[Time, Field(strict=False)]
    seq: Annotated[int | None, Field(ge=0, lt=2**63)] = None
    values: Annotated[dict[str, object], Field(min_length=1, max_length=128)]


_OBSERVED = TypeAdapter(Annotated[list[_Observed], Field(min_length=1, max_length=BATCH_LIMIT)])
_SETTLED = TypeAdapter(Annotated[list[_Settled], Field(max_length=BATCH_LIMIT)])


@dataclass(frozen=True, slots=True, kw_only=True)
class Settled:
    """What became of a sample at the service: it has it, or it refused it and why.

    With ``retry`` it may take it later: the sample is ahead of its clock.
    """

    stream: str
    t: datetime
    seq: int | None
    rejected: str | None = None
    retry: bool = False


def read_observed(
    stream: str, payload: bytes, streams: Mapping[str, tuple[str, ...]], *, until: datetime
) -> tuple[list[Sample], list[Settled]]:
    """Read a message of samples: those that can be stored, and those refused.

    ``stream``: whose topic it came by.
    ``payload``: ``{"t": …, "seq": …, "values": {…}}``, or a list of such.
    ``streams`` and ``until``: as for ``read_samples``.

    Raises InputError: nothing of the message can be read.
    """
    if len(payload) > LARGEST:
        raise InputError(f"{len(payload)} bytes are more than {LARGEST} of one message.")
    try:
        read = _OBSERVED.validate_json(_as_list(payload))
    except ValidationError as error:
        raise InputError(_first(error)) from error
    # Pydantic has just looked at t, seq and values; the stream is the topic's, however odd.
    received = [SampleIn.model_construct(stream=stream, **dict(one)) for one in read]
    samples, rejected = read_samples(received, streams, until=until)
    refused = [
        Settled(stream=stream, t=one.t, seq=one.seq, rejected=why.reason, retry=why.retry)
        for why in rejected
        for one in (read[why.index],)
    ]
    return samples, refused


def samples_text(samples: Sequence[Sample]) -> bytes:
    """Write samples of one stream as a message."""
    return _compact([sample_fields(sample) for sample in samples])


def sample_fields(sample: Sample) -> dict[str, object]:
    """Say a sample as a message or a request does, but for its stream; null for NaN."""
    values = {key: v if abs(v) < float("inf") else None for key, v in sample.values.items()}
    written: dict[str, object] = {"t": sample.t.isoformat(), "values": values}
    return written if sample.seq is None else written | {"seq": sample.seq}


def acknowledgement_text(settled: Sequence[Settled]) -> bytes:
    """Write acknowledgements of samples of one stream: an object for one, a list for more."""
    lines = [
        {"t": one.t.isoformat(), "seq": one.seq}
        | ({} if one.rejected is None else {"rejected": one.rejected})
        | ({"retry": True} if one.retry else {})
        for one in settled
    ]
    return _compact(lines[0] if len(lines) == 1 else lines)


def read_settled(stream: str, payload: bytes) -> tuple[Settled, ...]:
    """Read acknowledgements. Raises InputError: the message holds none."""
    try:
        read = _SETTLED.validate_json(_as_list(payload))
    except ValidationError as error:
        raise InputError(f"{stream}: an acknowledgement cannot be read: {_first(error)}") from error
    return tuple(Settled(stream=stream, **one.model_dump()) for one in read)


def _as_list(payload: bytes) -> bytes:
    return b"[" + payload + b"]" if payload.lstrip().startswith(b"{") else payload


def _first(error: ValidationError) -> str:
    first = error.errors(include_url=False, include_input=False, include_context=False)[0]
    place = ".".join(map(str, first["loc"]))
    return f"{place + ': ' if place else ''}{first['msg']}."


def _compact(value: object) -> bytes:
    return json.dumps(value, separators=(",", ":"), allow_nan=False).encode()
