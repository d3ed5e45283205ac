"""Intact rows of a damaged SQLite file, read page by page without SQLite.

Whatever the header, the tables' description or the inner pages say: a row is known by its own
checksum, which also says of which table it is. Rows of 0.1.0, which have none, are known by the
types of their columns, and only in a file that has such rows.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from struct import error as StructError  # noqa: N812
from struct import unpack, unpack_from
from typing import Any, BinaryIO

from seacage.service._store._database._checksum import CHECKED, UNVERIFIED, checksum

PAGE = 4096
_USABLE_INDEX = (PAGE - 12) * 64 // 255 - 23  # bytes of a row that lie in its page itself
_LEAST = (PAGE - 12) * 32 // 255 - 23
_FRAME = 24
_WHOLE = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8}  # bytes of whole numbers
_OLD = {"ttiittiN": "sample", "tttiiirrrN": "aggregate", "ttiN": "sealed", "ntitN": "journal"}
_LETTERS = {str: "t", int: "i", float: "r", type(None): "n"}
# Table and row, its checksum last; of the journal without the number of the line
Found = tuple[str, tuple[Any, ...]]


def intact_rows(path: Path) -> Iterator[Found]:
    """Read every intact row of a file, and of its log, in the order of the pages."""
    log = path.with_name(path.name + "-wal")
    with path.open("rb") as file, (log if log.exists() else path).open("rb") as frames:
        newer = _page_offsets(frames) if log.exists() else {}

        def page(number: int) -> bytes:
            source, at = (frames, newer[number]) if number in newer else (file, -1)
            source.seek(at if at >= 0 else (number - 1) * PAGE)
            return source.read(PAGE).ljust(PAGE, b"\0")

        first = page(1)
        old = b"DEFAULT -1" in first or first[60:64] == b"\0\0\0\1"
        count = max(path.stat().st_size // PAGE, *newer, 0)
        for number in range(1, count + 1):
            for record in _records(page, number):
                if found := _recognise(record, old=old):
                    yield found


def _page_offsets(frames: BinaryIO) -> dict[int, int]:
    """Where in the log the newest content of a page begins, as far as it was committed."""
    head, found, newer = frames.read(32), dict[int, int](), dict[int, int]()
    while len(frame := frames.read(_FRAME + PAGE)) == _FRAME + PAGE and frame[8:16] == head[16:24]:
        number, pages = unpack(">II", frame[:8])
        found[number] = frames.tell() - PAGE
        if pages:
            newer |= found
    return newer


def _records(page: Callable[[int], bytes], number: int) -> Iterator[tuple[Any, ...]]:
    """Decode the rows of one page that can be decoded."""
    content, start = page(number), 100 if number == 1 else 0
    kind = content[start]
    if kind not in {2, 10, 13}:  # inner and leaf of an index, leaf of a table
        return
    pointers = start + (12 if kind == 2 else 8)
    for k in range(min(int.from_bytes(content[start + 3 : start + 5]), PAGE // 4)):
        try:
            (at,) = unpack_from(">H", content, pointers + 2 * k)
            size, at = _varint(content, at + 4 if kind == 2 else at)
            at = _varint(content, at)[1] if kind == 13 else at
            yield _decode(
                _payload(page, content, at, size, PAGE - 35 if kind == 13 else _USABLE_INDEX)
            )
        except (IndexError, ValueError, KeyError, StructError):
            continue


def _payload(page: Callable[[int], bytes], content: bytes, at: int, size: int, most: int) -> bytes:
    """Put together what lies in the page and in those that it goes over into."""
    local = size
    if size > most:
        local = _LEAST + (size - _LEAST) % (PAGE - 4)
        local = local if local <= most else _LEAST
    parts, left = [content[at : at + local]], size - local
    following = int.from_bytes(content[at + local : at + local + 4])
    while left > 0 and following and len(parts) <= 1 + size // (PAGE - 4):
        content = page(following)
        following = int.from_bytes(content[:4])
        parts.append(content[4 : 4 + left])
        left -= len(parts[-1])
    return b"".join(parts)


def _decode(payload: bytes) -> tuple[Any, ...]:
    """Read the columns of a record."""
    end, at = _varint(payload, 0)
    body, row = end, list[Any]()
    while at < end:
        kind, at = _varint(payload, at)
        if kind in _WHOLE:
            size = _WHOLE[kind]
            row.append(int.from_bytes(payload[body : body + size], signed=True))
        elif kind == 7:
            size = 8
            row.append(unpack_from(">d", payload, body)[0])
        elif kind >= 13 and kind % 2:
            size = (kind - 13) // 2
            row.append(payload[body : body + size].decode())
        else:
            size = 0
            row.append({0: None, 8: 0, 9: 1}[kind])
        body += size
    if body != len(payload):
        raise ValueError
    return tuple(row)


def _varint(content: bytes, at: int) -> tuple[int, int]:
    value = 0
    for k in range(8):
        value = value << 7 | content[at + k] & 0x7F
        if content[at + k] < 0x80:
            return value, at + k + 1
    return value << 8 | content[at + 8], at + 9


def _recognise(record: Sequence[Any], *, old: bool) -> Found | None:
    for table in CHECKED:
        row = tuple(record[1:] if table == "journal" else record)
        if table == "aggregate" and len(row) == 10:
            # SQLite keeps a real number that is whole as a whole one.
            row = (*row[:6], *map(float, row[6:9]), row[9])
        if row and row[-1] == checksum(table, row[:-1]):
            return table, row
    letters = "".join(_LETTERS[type(one)] for one in record)
    for types, table in _OLD.items() if old else ():
        pairs = zip(letters, types, strict=False)
        if len(letters) == len(types) - 1 and all(a == b or a + b == "ir" for a, b in pairs):
            row = tuple(record[1:] if table == "journal" else record)
            return table, (*row, UNVERIFIED)
    return None
