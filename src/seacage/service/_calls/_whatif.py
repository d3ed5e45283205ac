"""What a cage would do in other water: the twin asked beside the live loop."""

from fastapi import APIRouter, Response

from seacage.ocean import SeaState
from seacage.service._calls._calls import WRITE, Live, may_read
from seacage.service._calls._routes import FRAME
from seacage.service._forms._schemas import WhatIf
from seacage.service._live._answers import state_of
from seacage.service._live._frame import MEDIA_TYPE, Flags, frame_of
from seacage.twin import Answered, Metocean

what_if = APIRouter(prefix="/api/v1/cages", tags=["cages"])


@what_if.post(
    "/{cage}/whatif",
    dependencies=may_read,
    response_class=Response,
    responses={**WRITE, **FRAME},
)
def ask_what_if(live: Live, body: WhatIf) -> Response:
    """Answer to water that is only imagined, as a frame with the flag 8; nothing is kept.

    The period only has to suit the height: a twin learns from seas whose period follows it.
    """
    sea = SeaState(
        current_speed=body.current_speed_m_s,
        current_to=body.current_to_deg,
        hs=body.hs_m,
        tp=body.tp_s,
        wave_from=body.wave_from_deg,
    )
    water, twin = Metocean.of(sea), live.twin
    answered = Answered(
        t=live.clock.now(), answer=twin.predict(water), metocean=water, input_age_s=0.0
    )
    state = state_of(live.name, twin, answered, twin.start())
    if state.water and sea.hs > 0.0:
        water_said = state.water.model_copy(update={"tp_s": round(sea.peak_period, 2)})
        state = state.model_copy(update={"water": water_said})
    frame = frame_of(state, answered, live.rest_position, about=Flags.WHAT_IF)
    return Response(frame, media_type=MEDIA_TYPE)
