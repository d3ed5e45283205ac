"""Samples sent to a running service over HTTP, until it has them on disk."""

import http.client
import json
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from urllib.parse import urlsplit

from seacage.conventions import InputError, SeacageError
from seacage.records import Sample
from seacage.service._schemas import BATCH_LIMIT, Receipt

_PATIENCE_S = (0.5, 1.0, 2.0, 4.0, 8.0)


class SendError(SeacageError):
    """A service does not take samples."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sender:
    """Sends samples to one cage of one service.

    Parameters
    ----------
    address
        Of the service: ``http://127.0.0.1:8000``.
    cage
        Its name there.
    token
        With the scope ingest.
    """

    address: str
    cage: str
    token: str

    def send(self, samples: Sequence[Sample]) -> Receipt:
        """Send samples, again where the service is away for a moment; once each is kept.

        Raises
        ------
        InputError
            The address is none, or the service refused the request.
        SendError
            Nobody answers.
        """
        parts = [
            self._sent(samples[first : first + BATCH_LIMIT])
            for first in range(0, len(samples), BATCH_LIMIT)
        ]
        return Receipt(
            accepted=sum(part.accepted for part in parts),
            duplicates=sum(part.duplicates for part in parts),
            rejected=[one for part in parts for one in part.rejected],
        )

    def _sent(self, samples: Sequence[Sample]) -> Receipt:
        body = json.dumps({"samples": [_said(sample) for sample in samples]})
        answer = ""
        for patience_s in (*_PATIENCE_S, None):
            try:
                status, answer = self._asked(body)
            except (OSError, http.client.HTTPException) as error:
                status, answer = 503, str(error)
            if status == 201:
                return Receipt.model_validate_json(answer)
            if status != 503:
                raise InputError(f"{self.address} refused the samples ({status}): {answer[:300]}")
            if patience_s is not None:
                time.sleep(patience_s)
        raise SendError(f"{self.address} takes no samples ({answer[:300]}). Is it running?")

    def _asked(self, body: str) -> tuple[int, str]:
        place = urlsplit(self.address)
        kinds = {"http": http.client.HTTPConnection, "https": http.client.HTTPSConnection}
        if place.scheme not in kinds or place.hostname is None:
            raise InputError(f"{self.address} is no address. Give one as http://127.0.0.1:8000.")
        connection = kinds[place.scheme](place.hostname, place.port, timeout=30.0)
        headers = {"Authorization": f"Bearer {self.token}", "Content-Type": "application/json"}
        path = f"{place.path.rstrip('/')}/api/v1/cages/{self.cage}/samples"
        try:
            connection.request("POST", path, body, headers)
            answer = connection.getresponse()
            return answer.status, answer.read().decode("utf-8", "replace")
        finally:
            connection.close()


def _said(sample: Sample) -> dict[str, object]:
    values = {key: v if math.isfinite(v) else None for key, v in sample.values.items()}
    said: dict[str, object] = {
        "stream": sample.stream,
        "t": sample.t.isoformat(),
        "values": values,
    }
    return said if sample.seq is None else said | {"seq": sample.seq}
