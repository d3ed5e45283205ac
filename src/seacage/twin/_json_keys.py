"""Keys of saved JSON that differ from the names of the fields."""


def json_keys(**keys: str) -> dict[str, object]:
    """Return the ``__pydantic_config__`` of a dataclass whose fields are saved under other keys.

    ``keys``: the key by the field's name; all other fields keep their names.
    """

    def key(field: str) -> str:
        return keys.get(field, field)

    return {"alias_generator": key}
