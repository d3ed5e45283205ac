"""Questions of a pilot to a running service."""

import http.client
import json
from dataclasses import dataclass
from urllib.parse import quote, urlsplit

from seacage.conventions import InputError, SeacageError
from seacage.service._clearance_schemas import (
    ClearanceAnswer,
    ClearanceAsked,
    InspectionAnswer,
    InspectionAsked,
)
from seacage.twin import StaleError


class AskError(SeacageError):
    """A service does not answer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Asker:
    """Asks about one cage of one service.

    Parameters
    ----------
    address
        Of the service: ``http://127.0.0.1:8000``.
    cage
        Its name there.
    token
        With the scope read.
    """

    address: str
    cage: str
    token: str

    def clearance(self, asked: ClearanceAsked) -> ClearanceAnswer:
        """Ask how far points are from the net."""
        answer = self.ask("clearance", asked.model_dump_json(exclude_none=True))
        return ClearanceAnswer.model_validate_json(answer)

    def inspection(self, asked: InspectionAsked) -> InspectionAnswer:
        """Ask for a way along the net."""
        answer = self.ask("inspection", asked.model_dump_json(exclude_none=True))
        return InspectionAnswer.model_validate_json(answer)

    def ask(self, call: str, body: str) -> bytes:
        """Post a question and return the answer's body.

        Raises
        ------
        InputError
            The address is none, or the question was refused.
        StaleError
            There is no net now.
        AskError
            Nobody answers, or not so.
        """
        try:
            status, answer = self._posted(call, body)
        except (OSError, http.client.HTTPException) as error:
            raise AskError(f"{self.address} does not answer ({error}). Is it running?") from error
        if status == http.client.OK:
            return answer
        why = _detail(answer)
        if status == http.client.CONFLICT:
            raise StaleError(why)
        if status in range(400, 500):
            raise InputError(f"{self.address} refused the question ({status}): {why}")
        raise AskError(f"{self.address} cannot answer ({status}): {why}")

    def _posted(self, call: str, body: str) -> tuple[int, bytes]:
        place = urlsplit(self.address)
        kinds = {"http": http.client.HTTPConnection, "https": http.client.HTTPSConnection}
        if place.scheme not in kinds or place.hostname is None:
            raise InputError(f"{self.address} is no address. Give one as http://127.0.0.1:8000.")
        connection = kinds[place.scheme](place.hostname, place.port, timeout=60.0)
        headers = {"Authorization": f"Bearer {self.token}", "Content-Type": "application/json"}
        path = f"{place.path.rstrip('/')}/api/v1/cages/{quote(self.cage, safe='')}/{call}"
        try:
            connection.request("POST", path, body, headers)
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()


def _detail(answer: bytes) -> str:
    text = answer.decode("utf-8", "replace")
    try:
        return str(json.loads(text)["detail"])
    except (ValueError, KeyError, TypeError):
        return text[:300]
