"""What the commands for ROV pilots share: whom to ask, and what an answer rests on."""

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from seacage.service._cli._console import refusal
from seacage.service._cli._options import InFolder, ServedCage

if TYPE_CHECKING:
    from seacage.service._rov._client import Ask
    from seacage.service._schemas._clearance import ClearanceAnswer, InspectionAnswer

Below = Annotated[float, typer.Option(min=0.0, max=100.0, help="Distance asked about, m.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class NetOptions:
    """The net that is asked about: of a twin's folder in a current, or of a running service.

    Options:
        twin: Folder of a twin, to be asked here.
        current_speed: With --twin: the current, m/s.
        current_to: With --twin: where it goes, degrees clockwise from north.
        hs: With --twin: significant wave height, m.
        wave_from: With --twin: where the waves come from, degrees.
        to: Address of a running service, as http://127.0.0.1:8000.
        token: For the service, with the scope read.
        allow_stale: Take the last reading however old it is.
        max_age: Refuse a reading older than this, s.
    """

    twin: InFolder = None
    current_speed: Annotated[float | None, typer.Option(min=0.0)] = None
    current_to: float | None = None
    hs: Annotated[float, typer.Option(min=0.0)] = 0.0
    wave_from: float = 0.0
    to: str | None = None
    cage: ServedCage = "ace"
    token: Annotated[str, typer.Option(envvar="SEACAGE_TOKEN")] = ""
    allow_stale: Annotated[bool, typer.Option("--allow-stale")] = False
    max_age: Annotated[float | None, typer.Option("--max-age", min=0.0)] = None

    def asker(self) -> "Ask":
        """A function that answers from the twin's folder, or from the service.

        Raises InputError: both or neither was named, or the twin without a current.
        """
        from seacage.service._rov._client import ANSWERS, ServiceAsker

        if (self.twin is None) == (self.to is None):
            raise refusal("Say whom to ask: --twin for a folder, or --to for a service.")
        if self.to is not None:
            return ServiceAsker(address=self.to, cage=self.cage, token=self.token).ask
        if self.twin is None or self.current_speed is None or self.current_to is None:
            raise refusal(
                "With --twin the current has to be said: --current-speed in m/s and --current-to "
                "in degrees."
            )
        from seacage.ocean import SeaState
        from seacage.twin import PredictedNet, Twin

        sea = SeaState(
            current_speed=self.current_speed,
            current_to=self.current_to,
            hs=self.hs,
            wave_from=self.wave_from,
        )
        predicted = PredictedNet.under(Twin.read(self.twin), sea, t=datetime.now(UTC))
        return lambda call, query: ANSWERS[call](predicted, query)


def about_rows(
    answer: "ClearanceAnswer | InspectionAnswer", out: Path | None
) -> list[tuple[str, str]]:
    """Say what an answer rests on, and where it was written."""
    learned = answer.shape_error
    error = f"learned from: {learned}" if learned else "not known, and so no probability"
    rows = [("Shape error", error), ("State", f"{answer.state_age_s:.0f} s old")]
    if answer.unlike:
        rows.append(("Unlike others", answer.unlike))
    if not answer.in_domain:
        rows.append(("Extrapolating", "the twin has not learned about such a current"))
    return rows if out is None else [*rows, ("Written", str(out))]
