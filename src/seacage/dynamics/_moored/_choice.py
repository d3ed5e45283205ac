"""Choice of what holds a cage's frame."""

from typing import Literal, get_args

from seacage.cage import Cage, Structure
from seacage.conventions import InputError
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._moored._pretension import assemble
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._parts._structure import assemble_structure

Mooring = Literal["catenary", "springs"]

SPRINGS = (
    "springs under the corners hold the frame nine times stiffer than its anchor lines; they are "
    "kept to go on with old campaigns, and mooring = catenary is the whole mooring."
)
"""Warning of results on springs."""


def moor(cage: Cage | Structure, mooring: Mooring, *, hold_collar: bool = False) -> Assembly:
    """The cage on frame ropes, buoys and anchor lines ("catenary"), or on corner "springs".

    A structure has lines and anchors of its own. The collar may be held in its place.

    Raises InputError: another mooring, and what the mooring asks of the cage that its file has not.
    """
    if mooring not in get_args(Mooring):
        raise InputError(f"mooring = {mooring!r} is none of: {', '.join(get_args(Mooring))}.")
    if isinstance(cage, Structure):
        if mooring != "catenary":
            raise InputError(
                f"mooring = {mooring!r}, but structure {cage.name} has lines and anchors of its "
                "own. Leave it out."
            )
        assembly = assemble_structure(cage)
    else:
        assembly = anchor_assembly(cage) if mooring == "catenary" else assemble(cage)
    return assembly.held() if hold_collar else assembly
