import pytest

CALLS = ["samples", "clearance", "whatif"]


@pytest.mark.parametrize("deep", [40, 40_000])
@pytest.mark.parametrize("call", CALLS)
def test_a_body_that_goes_deep_is_refused_as_a_malformed_one(idle, call, deep):
    for opened, closed in (("[", "]"), ('{"samples":', "}"), ('{"points_m":[', "]}")):
        body = opened * deep + "1" + closed * deep
        client = idle.logger if call == "samples" else idle.reader
        answer = client.post(
            f"/api/v1/cages/ace/{call}",
            content=body[: 1 << 18],
            headers={"Content-Type": "application/json"},
        )
        assert 400 <= answer.status_code < 500, answer.text
        assert len(answer.text) < 2000
