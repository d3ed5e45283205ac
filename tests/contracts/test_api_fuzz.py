"""Whatever is sent, the interface answers as it documents: never 5xx, never an unknown code."""

import httpx
import hypothesis
import jsonschema
import pytest

from running_service import buoy, depth, running
from seacage.service._auth._limits import Limits
from sizes import pick_size

# Schemathesis does what Hypothesis warns of.
pytestmark = pytest.mark.filterwarnings("ignore:Do not use the `random` module")
PLENTY = Limits(requests_per_s=1e6, burst=1e6, refusals_per_s=1e6, refusal_burst=1e6)


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    """A service that has heard something and never holds anybody up."""
    with running(tmp_path_factory.mktemp("fuzz"), limits=PLENTY) as one:
        one.post(buoy(-30), buoy(-10), depth(-15), depth(-10, stream="depth-1"))
        yield one


@pytest.fixture(scope="module")
def operations(service):
    """Every call that the interface describes."""
    described = httpx.get(f"{service.address}/openapi.json").json()
    import schemathesis  # heavy; most who collect this file do not run it

    schema = schemathesis.openapi.from_dict(described)
    return [operation.ok() for operation in schema.get_all_operations()]


def tried(service, operation, mode, cases):
    """Send so many cases of one call; how many were sent."""
    from schemathesis import GenerationMode
    from schemathesis.specs.openapi.checks import (
        ignored_auth,
        negative_data_rejection,
        positive_data_acceptance,
    )

    token = service.service.tokens.mint(["admin"], keep=False)
    headers, sent = {"Authorization": f"Bearer {token}"}, 0
    # A sea too steep to stand, or an alarm that there is not, is well formed, and refused.
    excluded = [positive_data_acceptance]
    if "service" in operation.tags:  # open to loopback
        excluded.append(ignored_auth)

    @hypothesis.settings(
        max_examples=cases,
        database=None,
        derandomize=True,
        suppress_health_check=list(hypothesis.HealthCheck),
        phases=[hypothesis.Phase.explicit, hypothesis.Phase.generate],
    )
    @hypothesis.given(case=operation.as_strategy(generation_mode=GenerationMode(mode)))
    def attempt(case):
        nonlocal sent
        sent += 1
        if mode == "positive" and "cage" in case.path_parameters:
            case.path_parameters["cage"] = "ace"  # else hardly any case would get past the name
        how = {"base_url": service.address, "headers": headers, "timeout": 60}
        answer = case.call(**how)
        # A body that is too long is refused as such, whatever else is wrong with it.
        too_long = [negative_data_rejection] if answer.status_code == 413 else []
        case.validate_response(
            answer, excluded_checks=excluded + too_long, headers=headers, transport_kwargs=how
        )

    attempt()
    return sent


def ways(operations):
    """Every call, made as it is meant and made wrongly."""
    modes = ("positive", "negative")
    return [(one, mode) for one in operations for mode in modes if can(one, mode)]


def fuzzed(service, operations, cases):
    return sum(tried(service, one, mode, cases) for one, mode in ways(operations))


def can(operation, mode):
    """Whether there is a wrong way to make a call: not where it has nothing to get wrong."""
    parts = (operation.path_parameters, operation.query, operation.headers)
    return mode == "positive" or bool(operation.body) or any(map(bool, parts))


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.timeout(pick_size(400, 7200))
def test_calls_made_well_and_badly_are_answered_as_documented(service, operations):
    least = pick_size(150, 10_000)
    # A few more each: some calls have few ways to differ.
    each = 1 + least * 21 // (20 * len(ways(operations)))
    assert fuzzed(service, operations, each) >= least


def test_every_call_documents_its_refusals_and_its_bounds(service):
    described = httpx.get(f"{service.address}/openapi.json").json()
    assert described["openapi"].startswith("3.1")
    for path, calls in described["paths"].items():
        for method, call in calls.items():
            where = f"{method} {path}"
            assert {"401", "429"} <= call["responses"].keys(), where
            assert call.get("description"), where
            for parameter in call.get("parameters", []):
                bounded = parameter["schema"].get("anyOf", [parameter["schema"]])[0]
                kind = bounded.get("type")
                assert kind != "string" or {"maxLength", "format", "enum"} & bounded.keys(), where


def examples_in(described):
    """The example of every body, and of every answer that people can read."""
    for path, calls in described["paths"].items():
        for method, call in calls.items():
            contents = {"body": call.get("requestBody", {}).get("content", {})}
            contents |= {
                code: call["responses"][code].get("content", {})
                for code in ("200", "201")
                if code in call["responses"]
            }
            for what, content in contents.items():
                for kind, medium in content.items():
                    if kind.startswith("text/") or kind.endswith("json"):
                        name = medium.get("schema", {}).get("$ref", "").rpartition("/")[2]
                        schema = described["components"]["schemas"].get(name, {})
                        yield (
                            f"{method} {path} {what}",
                            name,
                            [
                                *schema.get("examples", []),
                                *([medium["example"]] if "example" in medium else []),
                            ],
                        )


def test_every_body_and_every_answer_that_can_be_read_shows_an_example(service):
    shown = list(examples_in(httpx.get(f"{service.address}/openapi.json").json()))
    assert len(shown) > 40
    assert [where for where, _, examples in shown if not examples] == []


def test_every_example_is_what_its_call_takes_or_gives_with_all_that_belongs_there(service):
    described = httpx.get(f"{service.address}/openapi.json").json()
    # An example that lacks a key of an answer would teach readers an answer that never comes.
    for name, schema in described["components"]["schemas"].items():
        for example in schema.get("examples", []):
            checker = jsonschema.Draft202012Validator(
                {"$ref": f"#/components/schemas/{name}"} | described
            )
            assert [error.message for error in checker.iter_errors(example)] == [], name
            query = schema.get("additionalProperties") is False
            assert query or schema["properties"].keys() == example.keys(), name


def test_the_example_of_a_sample_is_taken(service):
    described = httpx.get(f"{service.address}/openapi.json").json()
    (example,) = described["components"]["schemas"]["SamplesIn"]["examples"]
    assert service.post(*example["samples"]).json()["rejected"] == []
