"""Examples of bodies that the description of the calls gives."""

import json
from importlib.resources import files

import pytest

from seacage.service._http import _api
from seacage.service._schemas._base import AbstractAnswer, AbstractRequest

EXAMPLES = json.loads((files("seacage.service._schemas") / "examples.json").read_text("utf-8"))


def models() -> dict[str, type[AbstractRequest | AbstractAnswer]]:
    assert _api.create_app  # imports all calls, and so all models
    found = [AbstractRequest, AbstractAnswer]
    for model in found:
        found += model.__subclasses__()
    return {model.__name__: model for model in found}


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_is_a_body_of_its_model(name: str):
    """Taken as it is, with no key of another spelling."""
    model = models()[name]
    shown = model.model_validate_json(json.dumps(EXAMPLES[name]))
    keys = {field.alias or key for key, field in model.model_fields.items()}
    assert set(EXAMPLES[name]) <= keys
    assert shown
