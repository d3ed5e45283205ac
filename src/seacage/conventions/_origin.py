"""Where numbers come from; every table row and figure says which."""

from enum import StrEnum


class Origin(StrEnum):
    """How a record or a table row was made."""

    MEASURED = "measured"
    COMPUTED = "computed"
    VIRTUAL_FIELD = "virtual field"
