"""Samples sent to a running service over HTTP, until it has them on disk."""

import json
import time
from collections.abc import Sequence
from dataclasses import dataclass

from seacage.conventions import InputError, SeacageError
from seacage.records import Sample
from seacage.service._mqtt._messages import sample_fields
from seacage.service._publish._post import POST_FAILED, AbstractCaller
from seacage.service._schemas._samples import Receipt

_LATER = (429, 503)


class SendError(SeacageError):
    """A service does not take samples."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sender(AbstractCaller):
    """Sends samples to one cage of one service; the token has the scope ingest."""

    # Pauses between tries while the service is away or has too much to do [s]
    patience_s: tuple[float, ...] = (0.5, 1.0, 2.0, 4.0, 8.0)

    def send(self, samples: Sequence[Sample]) -> Receipt:
        """Send as many samples as one request takes, again where the service is away for a moment.

        Raises InputError: the address is none, or the service refused the request.
        Raises SendError: nobody answers.
        """
        body = json.dumps(
            {"samples": [{"stream": one.stream} | sample_fields(one) for one in samples]}
        )
        answer = ""
        for pause_s in (0.0, *self.patience_s):
            time.sleep(pause_s)
            try:
                status, raw = self.post("samples", body, timeout_s=30.0)
                answer = raw.decode("utf-8", "replace")
            except POST_FAILED as error:
                status, answer = 503, str(error)
            if status == 201:
                return Receipt.model_validate_json(answer)
            if status not in _LATER:
                raise InputError(f"{self.address} refused the samples ({status}): {answer[:300]}")
        raise SendError(f"{self.address} takes no samples ({answer[:300]}). Is it running?")
