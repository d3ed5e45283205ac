"""What the commands for ROV pilots share: whom to ask, and what an answer rests on."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from seacage.service._rov._client import Asker
    from seacage.service._schemas._clearance import ClearanceAnswer, InspectionAnswer
    from seacage.twin import PredictedNet

TwinFolder = Annotated[
    Path | None,
    typer.Option(exists=True, file_okay=False, help="Folder of a twin, to be asked here."),
]
Speed = Annotated[float | None, typer.Option(min=0.0, help="With --twin: the current, m/s.")]
Towards = Annotated[
    float | None,
    typer.Option(help="With --twin: where it goes, degrees clockwise from north."),
]
Hs = Annotated[float, typer.Option(min=0.0, help="With --twin: significant wave height, m.")]
WaveFrom = Annotated[float, typer.Option(help="With --twin: where the waves come from, degrees.")]
To = Annotated[
    str | None, typer.Option(help="Address of a running service, as http://127.0.0.1:8000.")
]
CageThere = Annotated[str, typer.Option("--cage", help="The cage's name there.")]
Token = Annotated[
    str, typer.Option(envvar="SEACAGE_TOKEN", help="For the service, with the scope read.")
]
AllowStale = Annotated[
    bool, typer.Option("--allow-stale", help="Take the last reading however old it is.")
]
MaxAge = Annotated[
    float | None, typer.Option("--max-age", min=0.0, help="Refuse a reading older than this, s.")
]
Below = Annotated[float, typer.Option(min=0.0, max=100.0, help="Distance asked about, m.")]


def net_of(
    folder: Path | None,
    to: str | None,
    speed: float | None,
    towards: float | None,
    hs: float,
    wave_from: float,
) -> "PredictedNet | None":
    """Return the net of a twin's folder in a current; None where a service is asked."""
    from seacage.conventions import InputError

    if (folder is None) == (to is None):
        raise InputError("Say whom to ask: --twin for a folder, or --to for a service.")
    if folder is None:
        return None
    if speed is None or towards is None:
        raise InputError(
            "With --twin the current has to be said: --current-speed in m/s and --current-to in "
            "degrees."
        )
    from datetime import UTC, datetime

    from seacage.ocean import SeaState
    from seacage.twin import PredictedNet, Twin

    sea = SeaState(current_speed=speed, current_to=towards, hs=hs, wave_from=wave_from)
    return PredictedNet.under(Twin.read(folder), sea, t=datetime.now(UTC))


def asker_of(to: str | None, cage: str, token: str) -> "Asker":
    """Return who asks the service."""
    from seacage.service._rov._client import Asker

    assert to is not None  # `net_of` refused both and neither
    return Asker(address=to, cage=cage, token=token)


def about_rows(
    answer: "ClearanceAnswer | InspectionAnswer", out: Path | None
) -> list[tuple[str, str]]:
    """Say what an answer rests on, and where it was written."""
    learned = answer.shape_error
    error = f"learned from: {learned}" if learned else "not known, and so no probability"
    rows = [("Shape error", error), ("State", f"{answer.state_age_s:.0f} s old")]
    if not answer.in_domain:
        rows.append(("Extrapolating", "the twin has not learned about such a current"))
    return rows if out is None else [*rows, ("Written", str(out))]
