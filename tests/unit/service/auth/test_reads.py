"""The budget of long answers."""

import asyncio

import pytest
from fastapi import HTTPException

from seacage.service._auth._connections import Reads


@pytest.fixture(autouse=True)
def _no_pause(monkeypatch):
    monkeypatch.setattr("seacage.service._auth._connections._PAUSE_S", 0.0)


def take(reads, *amounts):
    asyncio.run(reads.take(*amounts))


def test_one_token_cannot_have_all_the_budget():
    reads = Reads(rows=20, rows_per_token=10)
    take(reads, "one", 10)
    with pytest.raises(HTTPException, match="this token") as refused:
        take(reads, "one", 1)
    assert refused.value.status_code == 429
    assert int(refused.value.headers["Retry-After"]) >= 1
    take(reads, "other", 10)


def test_many_tokens_cannot_have_more_than_all_the_budget():
    reads = Reads(rows=20, rows_per_token=10)
    take(reads, "one", 10)
    take(reads, "other", 10)
    with pytest.raises(HTTPException, match="others"):
        take(reads, "third", 1)


def test_what_is_given_back_can_be_taken_again():
    reads = Reads(rows=20, rows_per_token=10)
    for _ in range(5):
        take(reads, "one", 10)
        reads.give_back("one", 10)
    take(reads, "one", 4)
    take(reads, "one", 6)


def test_who_asks_while_an_answer_ends_gets_the_next():
    reads = Reads(rows=20, rows_per_token=10)
    take(reads, "one", 10)

    async def both():
        asyncio.get_running_loop().call_soon(reads.give_back, "one", 10)
        await reads.take("one", 10)

    asyncio.run(both())
