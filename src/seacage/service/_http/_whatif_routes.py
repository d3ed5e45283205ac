"""What a cage would do in other water: the twin asked beside the live loop."""

import math
from dataclasses import replace

from fastapi import APIRouter, Response

from seacage.ocean import SeaState
from seacage.records import SEA_COLUMNS
from seacage.service._http._cage_routes import FRAME
from seacage.service._http._dependencies import READ, WRITE, At, Live, may_read
from seacage.service._live._answers import state_of, what_if_parted
from seacage.service._live._frame import MEDIA_TYPE, Flags, frame_of
from seacage.service._schemas._cages import Learned, LearnedInput, WhatIf, WhatIfParted
from seacage.service._schemas._state import Water
from seacage.twin import Answered, Metocean, Twin

# Strength and direction of each kind of input, in the order of the twin's edges
_KEYS = {"current": ("current_speed_m_s", "current_to_deg"), "waves": ("hs_m", "wave_from_deg")}
_WAVES = ("hs_m", "tp_s", "wave_from_deg")
what_if = APIRouter(prefix="/api/v1/cages", tags=["cages"])


@what_if.get("/{cage}/whatif", dependencies=may_read, responses=READ)
async def get_training_domain(live: Live) -> Learned:
    """Say what a what-if can ask: the inputs that the twin was trained with, and how far."""
    return training_domain_of(live.twin)


@what_if.post(
    "/{cage}/whatif", dependencies=may_read, response_class=Response, responses=WRITE | FRAME
)
def ask_what_if(live: Live, body: WhatIf) -> Response:
    """Answer to water that is only imagined, as a frame with the flag 8; nothing is kept.

    Of the period only the loads of lines know; the bridles, the sensors and the shape are learned
    from seas whose period follows their height. The answer's ``water`` says what of the question
    counted: null is what the twin knows nothing of.
    """
    sea = SeaState(**{SEA_COLUMNS[key]: value for key, value in body})
    # At one depth, as a buoy's, where the twin takes a profile
    water, past, now = replace(Metocean.of(sea), profile=None), live.past, live.clock.now()
    twin = past.twin
    answered = Answered(t=now, answer=twin.predict(water), metocean=water, input_age_s=0.0)
    state = state_of(live.name, twin, answered, twin.start()).model_copy(update={"twin": past.id})
    if state.water:
        state = state.model_copy(update={"water": effective_water(state.water, sea, twin)})
    frame = frame_of(state, answered, live.rest_position, about=Flags.WHAT_IF)
    return Response(frame, media_type=MEDIA_TYPE)


@what_if.get("/{cage}/what-if-parted", dependencies=may_read, responses=READ)
def get_what_if_parted(live: Live, at: At = None) -> WhatIfParted:
    """Say what the other lines would bear if each line parted in the water of now, or of then."""
    snapshot = live.snapshot_at(at)
    return what_if_parted(live.name, snapshot.twin, snapshot.answered)


def training_domain_of(twin: Twin) -> Learned:
    """Return which inputs a twin was trained with, and up to where."""
    keys = [key for name in twin.models.inputs for key in _KEYS.get(name, ())]
    most = dict(zip((strength for strength, _ in _KEYS.values()), twin.models.edge, strict=True))
    if twin.emulator is not None:
        hs, log_tp = twin.emulator.domain.upper[1:3].tolist()
        keys = [*_KEYS["current"], *_WAVES]
        most |= {"hs_m": round(hs, 2), "tp_s": round(math.exp(log_tp), 1)}
    inputs = [LearnedInput(key=key, most=most.get(key)) for key in keys]
    return Learned(inputs=inputs, unknown=sorted(WhatIf.model_fields.keys() - set(keys)))


def effective_water(water: Water, sea: SeaState, twin: Twin) -> Water:
    """Leave of imagined water what the answer rests on; the period is that of the height."""
    if "waves" not in twin.models.inputs and twin.emulator is None:
        return water.model_copy(update=dict.fromkeys(_WAVES))
    if sea.hs > 0.0:
        return water.model_copy(update={"tp_s": round(sea.peak_period, 2)})
    return water
