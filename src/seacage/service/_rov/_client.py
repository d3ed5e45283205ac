"""Questions of a pilot, answered here or by a running service."""

import json
from abc import ABC, abstractmethod
from dataclasses import dataclass
from http import HTTPStatus

from seacage.conventions import InputError, SeacageError
from seacage.service._publish._post import POST_FAILED, AbstractCaller
from seacage.service._rov._clearance import clearance_answer, inspection_answer, inspection_of
from seacage.service._rov._files import inspection_geojson, inspection_mcap
from seacage.service._schemas._clearance import (
    ClearanceAnswer,
    ClearanceQuery,
    InspectionAnswer,
    InspectionQuery,
)
from seacage.twin import PredictedNet, StaleError


class AskError(SeacageError):
    """A service does not answer."""


class AbstractAsker(ABC):
    """Answers about one net, here or elsewhere."""

    @abstractmethod
    def clearance(self, query: ClearanceQuery) -> ClearanceAnswer:
        """How far points are from the net."""

    @abstractmethod
    def inspection(self, query: InspectionQuery) -> InspectionAnswer:
        """A way along the net."""

    @abstractmethod
    def inspection_file(self, form: str, query: InspectionQuery) -> bytes:
        """The same way as a file, ``.mcap`` or ``.geojson``."""


class LocalAsker(AbstractAsker):
    """Answers from a predicted net.

    Parameters
    ----------
    net
        The net that is asked about.
    """

    def __init__(self, net: PredictedNet) -> None:
        self._net = net

    def clearance(self, query: ClearanceQuery) -> ClearanceAnswer:
        return clearance_answer(self._net, query)

    def inspection(self, query: InspectionQuery) -> InspectionAnswer:
        return inspection_answer(self._net, query)

    def inspection_file(self, form: str, query: InspectionQuery) -> bytes:
        write = inspection_mcap if form == ".mcap" else inspection_geojson
        return write(self._net, inspection_of(self._net, query))


@dataclass(frozen=True, slots=True, kw_only=True)
class ServiceAsker(AbstractCaller, AbstractAsker):
    """Answers of a service about one of its cages; the token has the scope read."""

    def clearance(self, query: ClearanceQuery) -> ClearanceAnswer:
        answer = self.ask("clearance", query.model_dump_json(exclude_none=True))
        return ClearanceAnswer.model_validate_json(answer)

    def inspection(self, query: InspectionQuery) -> InspectionAnswer:
        answer = self.ask("inspection", query.model_dump_json(exclude_none=True))
        return InspectionAnswer.model_validate_json(answer)

    def inspection_file(self, form: str, query: InspectionQuery) -> bytes:
        return self.ask(f"inspection{form}", query.model_dump_json(exclude_none=True))

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
