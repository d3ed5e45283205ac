"""What a cage would bear if one of its lines parted."""

from seacage.twin._parted._if_parted import IfParted
from seacage.twin._parted._parted_lines import NO_PARTED_LINES, STATE, PartedKind, PartedLines

__all__ = ["NO_PARTED_LINES", "STATE", "IfParted", "PartedKind", "PartedLines"]
