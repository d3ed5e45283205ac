"""Questions of a pilot, answered here or by a running service."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

from seacage.conventions import InputError, SeacageError
from seacage.service._publish._post import POST_FAILED, AbstractCaller
from seacage.service._rov._clearance import clearance_answer, inspection_answer
from seacage.service._rov._files import inspection_geojson, inspection_mcap
from seacage.service._schemas._clearance import ClearanceQuery, InspectionQuery
from seacage.twin import PredictedNet, StaleError


class AskError(SeacageError):
    """A service does not answer."""


Query = ClearanceQuery | InspectionQuery
Ask = Callable[[str, Query], bytes]  # answers a call about one net as a service does: the body

# What answers a call about a predicted net
ANSWERS: Mapping[str, Callable[[PredictedNet, Any], bytes]] = {
    "clearance": lambda net, query: clearance_answer(net, query).model_dump_json().encode(),
    "inspection": lambda net, query: inspection_answer(net, query).model_dump_json().encode(),
    "inspection.mcap": inspection_mcap,
    "inspection.geojson": inspection_geojson,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class ServiceAsker(AbstractCaller):
    """Answers of a service about one of its cages; the token has the scope read."""

    def ask(self, call: str, query: Query) -> bytes:
        """Post a question and return the answer's body.

        Raises InputError: the address is none, or the question was refused.
        Raises StaleError: there is no net now.
        Raises AskError: nobody answers, or not so.
        """
        try:
            status, answer = self.post(call, query.model_dump_json(exclude_none=True))
        except POST_FAILED as error:
            raise AskError(f"{self.address} does not answer ({error}). Is it running?") from error
        if status == HTTPStatus.OK:
            return answer
        why = _detail(answer)
        if status == HTTPStatus.CONFLICT:
            raise StaleError(why)
        if status in range(400, 500):
            raise InputError(f"{self.address} refused the question ({status}): {why}")
        raise AskError(f"{self.address} cannot answer ({status}): {why}")


def _detail(answer: bytes) -> str:
    text = answer.decode("utf-8", "replace")
    try:
        return str(json.loads(text)["detail"])
    except (ValueError, KeyError, TypeError):
        return text[:300]
