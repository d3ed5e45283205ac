"""Questions of a pilot to a running service."""

import json
from dataclasses import dataclass
from http import HTTPStatus

from seacage.conventions import InputError, SeacageError
from seacage.service._publish._post import POST_FAILED, AbstractCaller
from seacage.service._schemas._clearance import (
    ClearanceAnswer,
    ClearanceQuery,
    InspectionAnswer,
    InspectionQuery,
)
from seacage.twin import StaleError


class AskError(SeacageError):
    """A service does not answer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Asker(AbstractCaller):
    """Asks about one cage of one service; its token has the scope read."""

    def clearance(self, query: ClearanceQuery) -> ClearanceAnswer:
        """Ask how far points are from the net."""
        answer = self.ask("clearance", query.model_dump_json(exclude_none=True))
        return ClearanceAnswer.model_validate_json(answer)

    def inspection(self, query: InspectionQuery) -> InspectionAnswer:
        """Ask for a way along the net."""
        answer = self.ask("inspection", query.model_dump_json(exclude_none=True))
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
            status, answer = self.post(call, body)
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
