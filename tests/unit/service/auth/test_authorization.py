import shutil
import socket

import httpx
import pytest

from running_service import Running, buoy, eventually, running
from seacage.service._auth._authorization import same_origin
from seacage.service._auth._limits import Limits

READING = ["cages", "cages/ace/state", "cages/ace/samples", "cages/ace/history", "cages/ace/shape"]


@pytest.mark.parametrize("path", READING)
def test_reading_takes_a_token(idle: Running, path):
    answer = httpx.get(f"{idle.address}/api/v1/{path}")
    assert answer.status_code == 401
    assert answer.headers["www-authenticate"] == "Bearer"


@pytest.mark.parametrize("path", READING)
def test_a_token_that_only_sends_may_not_read(idle: Running, path):
    assert idle.logger.get(f"/api/v1/{path}").status_code == 403


def test_a_token_that_only_reads_may_not_send(idle: Running):
    answer = idle.reader.post("/api/v1/cages/ace/samples", json={"samples": [buoy()]})
    assert answer.status_code == 403


def test_a_guessed_token_is_refused_without_saying_which_cages_there_are(idle: Running):
    headers = {"Authorization": "Bearer guess"}
    answer = httpx.get(f"{idle.address}/api/v1/cages/ice/state", headers=headers)
    assert answer.status_code == 401


def test_a_token_for_one_cage_does_not_open_another(idle: Running):
    token = idle.service.tokens.mint(["read:ice"], keep=False)
    headers = {"Authorization": f"Bearer {token}"}
    answer = httpx.get(f"{idle.address}/api/v1/cages/ace/state", headers=headers)
    assert answer.status_code == 403


def test_a_token_for_a_site_opens_each_of_its_cages(tmp_path):
    with running(tmp_path, site="bay") as one:
        headers = {"Authorization": f"Bearer {one.service.tokens.mint(['read:bay'], keep=False)}"}
        assert httpx.get(f"{one.address}/api/v1/cages/ace/state", headers=headers).is_success
        headers = {"Authorization": f"Bearer {one.service.tokens.mint(['read:sea'], keep=False)}"}
        answer = httpx.get(f"{one.address}/api/v1/cages/ace/state", headers=headers)
        assert answer.status_code == 403


def test_whoever_asks_too_often_learns_when_to_ask_again(tmp_path):
    with running(tmp_path, limits=Limits(requests_per_s=0.1, burst=3)) as one:
        answers = [one.reader.get("/api/v1/cages") for _ in range(4)]
        assert [answer.status_code for answer in answers] == [200, 200, 200, 429]
        assert 1 <= int(answers[3].headers["retry-after"]) <= 10
        assert one.post(buoy()).status_code == 201, "another token has a bucket of its own"


def test_nobody_guesses_tokens_for_long(tmp_path):
    with running(tmp_path, limits=Limits(refusals_per_s=0.1, refusal_burst=2)) as one:
        guess = {"url": f"{one.address}/api/v1/cages", "headers": {"Authorization": "Bearer guess"}}
        answers = [httpx.get(**guess).status_code for _ in range(4)]
        assert answers == [401, 401, 429, 429]
        assert one.reader.get("/api/v1/cages").status_code == 200, "who is known still passes"


def request_from(one: Running, address, path="/api/v1/cages", token="guess"):
    headers = {"X-Forwarded-For": address, "Authorization": f"Bearer {token}"}
    return httpx.get(f"{one.address}{path}", headers=headers)


def test_an_address_that_only_the_asker_names_escapes_no_limit(tmp_path):
    with running(tmp_path, limits=Limits(refusals_per_s=0.1, refusal_burst=2)) as one:
        answers = [request_from(one, f"10.0.0.{number}").status_code for number in range(4)]
        assert answers == [401, 401, 429, 429]


def test_a_proxy_that_the_settings_name_is_believed(tmp_path):
    limits = Limits(refusals_per_s=0.1, refusal_burst=2)
    with running(tmp_path, limits=limits, proxies=("127.0.0.0/8",)) as one:
        answers = [request_from(one, f"10.0.0.{number}").status_code for number in range(4)]
        assert answers == [401] * 4, "each has a bucket of its own"
        forged = [request_from(one, f"10.9.9.{n}, 10.0.0.9").status_code for n in range(4)]
        assert forged == [401, 401, 429, 429], "only the last address is the proxy's own word"
        forged = [request_from(one, f"no address {n}").status_code for n in range(4)]
        assert forged == [401, 401, 429, 429]


@pytest.mark.parametrize("proxies", [(), ("127.0.0.1",)])
@pytest.mark.parametrize("header", ["X-Forwarded-For", "Forwarded", "X-Real-IP"])
@pytest.mark.parametrize("path", ["/metrics", "/readyz", "/openapi.json"])
def test_what_a_proxy_brings_is_not_from_this_machine(shared, proxies, header, path):
    answer = httpx.get(f"{shared[proxies].address}{path}", headers={header: "127.0.0.1"})
    assert answer.status_code == 401


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """A service that believes nobody, and one that believes a proxy on this machine."""
    folders = [tmp_path_factory.mktemp(name) for name in ("alone", "behind")]
    proxy = ("127.0.0.1",)
    with running(folders[0]) as alone, running(folders[1], proxies=proxy) as behind:
        yield {(): alone, proxy: behind}


def test_a_token_that_is_not_known_is_reported_as_such(idle: Running):
    none = httpx.get(f"{idle.address}/api/v1/cages")
    wrong = httpx.get(f"{idle.address}/api/v1/cages", headers={"Authorization": "Bearer guess"})
    assert "not known" not in none.text
    assert "This token or session is not known here" in wrong.json()["detail"]
    assert wrong.headers["www-authenticate"] == 'Bearer error="invalid_token"'


@pytest.mark.parametrize(
    ("method", "path", "allowed"),
    [
        ("PATCH", "/session", "DELETE, GET, POST"),
        ("DELETE", "/api/v1/cages/ace/samples", "GET, POST"),
        ("PUT", "/api/v1/cages/ace/whatif", "GET, POST"),
        ("POST", "/healthz", "GET"),
    ],
)
def test_a_method_that_a_path_does_not_take_is_answered_with_those_it_does(
    idle: Running, method, path, allowed
):
    answer = httpx.request(method, f"{idle.address}{path}")
    assert answer.status_code == 405
    assert answer.headers["allow"] == allowed


def test_a_token_for_one_cage_learns_of_no_other(tmp_path):
    with running(tmp_path, names=("quebec", "zulu")) as one:
        token = one.service.tokens.mint(["read:zulu"], keep=False)
        mine = {"Authorization": f"Bearer {token}", "X-Real-IP": "10.0.0.1"}
        listed = httpx.get(f"{one.address}/api/v1/cages", headers=mine).json()["cages"]
        assert [cage["name"] for cage in listed] == ["zulu"]
        metrics = eventually(
            lambda: httpx.get(f"{one.address}/metrics", headers=mine).text,
            lambda text: 'cage="zulu"' in text,  # stepped once
        )
        assert 'cage="zulu"' in metrics
        assert "quebec" not in metrics
        assert "seacage_quarantined 0" not in metrics, "the whole service's affair"
        assert 'cage="quebec"' in httpx.get(f"{one.address}/metrics").text
        other = one.service.tokens.mint(["read:none"], keep=False)
        lost = httpx.get(
            f"{one.address}/api/v1/cages/none/state", headers={"Authorization": f"Bearer {other}"}
        )
        assert lost.status_code == 404
        assert "quebec" not in lost.text
        one.service._tasks[0].cancel()
        trouble = httpx.get(f"{one.address}/readyz", headers=mine)
        assert "quebec" not in trouble.text


def half_sent(one: Running, *lines):
    """What is answered to the head of a request whose body never comes."""
    host, port = one.address.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=5) as line:
        head = ["POST /api/v1/cages/ace/samples HTTP/1.1", "Host: x", "Content-Length: 90", *lines]
        line.sendall("".join(f"{one}\r\n" for one in [*head, ""]).encode())
        return line.recv(1000).decode()


def test_the_token_is_checked_before_the_body(idle: Running):
    json = "Content-Type: application/json"
    assert half_sent(idle, json).startswith("HTTP/1.1 401")
    assert half_sent(idle, json, "Authorization: Bearer guess").startswith("HTTP/1.1 401")


ODD = ["..", "%2e%2e", "..%2f..%2fetc%2fpasswd", "%00", "a%00b", "%ff", "a" * 65, "ace%2f.."]


@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize("path", ["{}/state", "{}/samples", "{}/frame", "{}/topology"])
def test_no_name_of_a_cage_leads_anywhere_else(idle: Running, odd, path):
    answer = idle.reader.get(f"/api/v1/cages/{path.format(odd)}")
    assert answer.status_code in {404, 422}


@pytest.mark.parametrize("odd", ["../x", "%00", "-", "a b", "a" * 65, "%ed%a0%80"])
def test_no_name_of_a_stream_is_taken_that_no_stream_can_have(idle: Running, odd):
    assert idle.reader.get(f"/api/v1/cages/ace/samples?stream={odd}").status_code == 422


@pytest.mark.parametrize("path", ["", "page/main.js", "healthz", "api/v1/cages", "no-such"])
def test_every_answer_carries_the_browsers_rules(idle: Running, path):
    headers = httpx.get(f"{idle.address}/{path}").headers
    policy = headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    assert headers["x-content-type-options"] == "nosniff"


@pytest.fixture
def built(tmp_path, monkeypatch):
    """A page as its build leaves it."""
    folder = tmp_path / "page"
    folder.mkdir()
    (folder / "index.html").write_text("<title>seacage</title>")
    (folder / "assets").mkdir()
    (folder / "assets" / "index-a1b2.js").write_text("1;")
    monkeypatch.setattr("seacage.service._http._api.PAGE", folder)
    return folder


def test_the_page_lies_at_the_root_and_its_folder_gives_nothing_else_away(built, tmp_path):
    (tmp_path / "secret.txt").write_text("secret")
    with running(tmp_path) as one:
        assert "<title>seacage</title>" in httpx.get(one.address).text
        for odd in ("%2e%2e/secret.txt", "..%2fsecret.txt", "%2e%2e%2fsecret.txt", ""):
            assert httpx.get(f"{one.address}/page/{odd}").status_code == 404


def test_only_files_whose_names_hold_a_hash_are_kept_by_a_browser(built, tmp_path):
    with running(tmp_path) as one:
        assert "no-cache" in httpx.get(one.address).headers["cache-control"]
        kept = httpx.get(f"{one.address}/page/assets/index-a1b2.js").headers["cache-control"]
        assert "immutable" in kept
        missing = httpx.get(f"{one.address}/page/assets/none.js")
        assert "no-cache" in missing.headers["cache-control"]


def test_a_service_whose_page_was_not_built_serves_all_else_and_says_so(built, tmp_path):
    shutil.rmtree(built)
    with running(tmp_path) as one:
        answer = httpx.get(one.address)
        assert answer.status_code == 404
        assert "make page" in answer.text
        assert one.reader.get("/api/v1/cages").is_success


@pytest.mark.parametrize(
    ("origin", "host", "same"),
    [
        (None, "cage.example", True),
        ("http://cage.example", "cage.example", True),
        ("https://cage.example", "cage.example", True),
        ("https://elsewhere.example", "cage.example", False),
        ("null", "cage.example", False),
        ("http://cage.example", "cage.example:8000", False),
    ],
)
def test_only_our_own_page_opens_a_live_connection(origin, host, same):
    assert same_origin(origin, host) is same
