import pytest

from seacage.conventions import InputError
from seacage.service._mqtt._topics import Topics, share


def test_a_topic_leads_back_to_its_cage_and_stream():
    topics = Topics("south")
    assert topics.address(topics.samples("ace", "buoy-1")) == ("ace", "buoy-1")
    assert topics.address(topics.acknowledgements("ace", "buoy-1")) == ("ace", "buoy-1")


@pytest.mark.parametrize(
    "topic",
    [
        "",
        "seacage/v1/north/ace/buoy-1/obs",
        "seacage/v2/south/ace/buoy-1/obs",
        "seacage/v1/south/ace/buoy-1/obs/more",
        "seacage/v1/south/ace/obs",
        "seacage/v1/south//buoy-1/obs",
        "seacage/v1/south/ace/buoy-1/state",
    ],
)
def test_another_topic_leads_nowhere(topic):
    assert Topics("south").address(topic) is None


@pytest.mark.parametrize("site", ["", "a/b", "+", "#", "a b", "x" * 65])
def test_a_site_is_one_level(site):
    with pytest.raises(InputError, match="no site's name"):
        Topics(site)


def test_a_group_shares_a_topic():
    assert share("a/b", None) == "a/b"
    assert share("a/b", "twins") == "$share/twins/a/b"
