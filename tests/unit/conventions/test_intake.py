import os
import socket

import pytest

from seacage.conventions import (
    InputError,
    ModelError,
    NonsenseError,
    check_file,
    parse_json,
    parse_toml,
    read_bytes,
    read_text,
)


@pytest.fixture
def pipe(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    return tmp_path / "pipe"


def test_a_regular_file_is_read_whole(tmp_path):
    (tmp_path / "a").write_bytes(b"12345")
    assert read_bytes(tmp_path / "a", most=5) == b"12345"


def test_a_larger_file_is_not_read(tmp_path):
    with (tmp_path / "a").open("wb") as file:
        file.truncate(300 << 20)
    with pytest.raises(InputError, match="has 314572800 bytes, and at most 1048576 are read"):
        read_bytes(tmp_path / "a", most=1 << 20)


def test_neither_a_pipe_nor_a_socket_nor_a_folder_is_waited_for(tmp_path, pipe):
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(str(tmp_path / "socket"))
        for path in (pipe, tmp_path / "socket", tmp_path, "/dev/zero"):
            with pytest.raises(InputError, match="no regular file"):
                read_bytes(path, most=1 << 20)


def test_a_link_to_a_device_or_a_pipe_is_no_file(tmp_path, pipe):
    for name, target in {"zero": "/dev/zero", "piped": pipe}.items():
        (tmp_path / name).symlink_to(target)
        with pytest.raises(InputError, match="no regular file"):
            read_bytes(tmp_path / name, most=1 << 20)


def test_a_link_to_a_file_is_taken_only_where_links_are(tmp_path):
    (tmp_path / "a").write_bytes(b"1")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    assert read_bytes(tmp_path / "b", most=5) == b"1"
    with pytest.raises(InputError, match="no regular file"):
        read_bytes(tmp_path / "b", most=5, links=False)


def test_a_pipe_that_takes_a_files_place_is_not_waited_for(tmp_path, pipe, monkeypatch):
    monkeypatch.setattr("seacage.conventions._intake.check_file", lambda *_, **__: None)
    with pytest.raises(InputError, match="no regular file"):
        read_bytes(pipe, most=1 << 20)


def test_a_check_opens_nothing(pipe):
    with pytest.raises(InputError, match="no regular file"):
        check_file(pipe, most=1)


@pytest.mark.parametrize("deep", [40, 100_000])
@pytest.mark.parametrize(
    ("parse", "text"),
    [
        (parse_json, lambda deep: "[" * deep + "]" * deep),
        (parse_json, lambda deep: '{"a":' * deep + "1" + "}" * deep),
        (parse_toml, lambda deep: "a = " + "[" * deep + "]" * deep),
        (parse_toml, lambda deep: ".".join("a" * min(deep, 5000)) + " = 1"),
    ],
    ids=["lists", "objects", "toml", "dotted"],
)
def test_what_lies_deep_is_refused_in_a_sentence(parse, text, deep):
    with pytest.raises(InputError, match=r"mine: .* more than 32 deep"):
        parse(text(deep), "mine")


def test_what_lies_as_deep_as_is_allowed_is_taken():
    assert parse_json("[" * 32 + "]" * 32, "mine")
    with pytest.raises(InputError, match="deep"):
        parse_json("[" * 34 + "]" * 34, "mine")


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999"])
def test_a_number_that_is_none_is_no_json(number):
    with pytest.raises(InputError, match="is no finite number"):
        parse_json(f'{{"a": {number}}}', "mine")


def test_where_finite_numbers_are_requested_the_key_of_another_is_named():
    text = "[[a]]\nb.c = 1\n[[a]]\nb.c = -inf"
    assert parse_toml(text, "mine")
    with pytest.raises(NonsenseError, match=r"mine: a\.b\.c = -inf is no finite number"):
        parse_toml(text, "mine", finite=True)


def test_a_refusal_is_of_the_kind_that_the_reader_asks_for(tmp_path):
    (tmp_path / "photo").write_bytes(b"\xff\xd8")
    with pytest.raises(ModelError, match=r"photo: the file cannot be read \(it is no UTF-8 text"):
        read_text(tmp_path / "photo", refusal=ModelError)
    with pytest.raises(ModelError, match=r"nowhere: the file cannot be read \(No such file"):
        read_text(tmp_path / "nowhere", refusal=ModelError)
