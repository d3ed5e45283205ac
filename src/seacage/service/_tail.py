"""A table that a logger appends to, followed row by row."""

import hashlib
import json
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import BinaryIO, Self

import structlog

from seacage.conventions import RecordError, check_file
from seacage.records import ColumnMap, Sample, check_rows, read_rows

_HEAD = 1024  # bytes at the beginning that tell one file from another
_MOST = 1 << 20  # bytes that are read at a time
_log = structlog.get_logger(__name__)
# Is told where a row stands, the row, and why it cannot be read
Refuse = Callable[[str, bytes, str], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class TailPosition:
    """How far a file was read."""

    # Up to the end of which row: bytes and lines
    offset: int = 0
    line: int = 0
    head: str = ""  # hash of what the file began with, as far as ``offset`` or a kilobyte

    @classmethod
    def parse(cls, text: str) -> Self:
        """Read what ``str`` wrote; the beginning where it is nothing of the kind."""
        with suppress(ValueError, TypeError):
            return cls(**json.loads(text))
        return cls()

    def __str__(self) -> str:
        """As JSON, to be kept."""
        return json.dumps(asdict(self))


@dataclass(slots=True, kw_only=True)
class Tail:
    """Reads what was appended to a table since the last look.

    A row counts once its line has ended. The logger may begin the file anew, in its place or
    as another file of its name: the rest of the old one is read first. A row that cannot be
    read is refused and the others are not.
    """

    path: Path  # of the file; it may come later
    columns: ColumnMap | None = None  # what its columns mean; by its header where None
    stream: str = "buoy-1"  # what to call the stream
    refuse: Refuse  # is told of rows that cannot be read
    place: TailPosition = field(default_factory=TailPosition)  # where to read on, after a restart
    _file: BinaryIO | None = None
    _header: str = ""

    def poll(self) -> tuple[Sample, ...]:
        """Read the rows that are new; afterwards ``place`` is behind them.

        Raises OSError: the file is there and cannot be read.
        Raises RecordError: its header is not that of its map, so no row can be read.
        """
        file = self._file or self._open()
        if file is None:
            return ()
        shorter = os.fstat(file.fileno()).st_size < self.place.offset
        if shorter or self.place.head != self._hash(file, self.place.offset):
            _log.info("file begins anew", path=str(self.path))
            self.place, self._header = TailPosition(), ""
        samples = self._rows(file)
        if not samples and self._is_replaced(file):
            self._leave(file)
            return self.poll()
        return samples

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def _open(self) -> BinaryIO | None:
        if self.path.exists():  # a pipe would hold the opening for ever
            check_file(self.path, most=sys.maxsize, refusal=RecordError)
        try:
            self._file = self.path.open("rb")
        except FileNotFoundError:
            return None
        if not self._header and self.place.line:  # to go on below it
            lines = [self._file.readline() for _ in range(self._skip_lines + 1)]
            self._header = self._text(lines[-1])
        return self._file

    def _is_replaced(self, file: BinaryIO) -> bool:
        mine = os.fstat(file.fileno())
        try:
            its = self.path.stat()
        except FileNotFoundError:
            return False
        return (mine.st_dev, mine.st_ino) != (its.st_dev, its.st_ino)

    def _leave(self, file: BinaryIO) -> None:
        """Be done with a file that another has replaced."""
        file.seek(self.place.offset)
        if rest := file.read(_MOST):
            where = f"{self.path}, line {self.place.line + 1}"
            self.refuse(where, rest, "The file ended inside this row, so a number may be cut.")
        self.close()
        self.place, self._header = TailPosition(), ""

    def _rows(self, file: BinaryIO) -> tuple[Sample, ...]:
        file.seek(self.place.offset)
        content = file.read(_MOST)
        whole = content[: content.rfind(b"\n") + 1]
        if not whole:
            if len(content) == _MOST:
                raise RecordError(f"{self.path}: a line is longer than {_MOST} bytes. Is it text?")
            return ()
        first = self.place.line
        # At line feeds alone: a carriage return before one belongs to its line.
        lines = [line + b"\n" for line in whole.split(b"\n")[:-1]]
        offset = self.place.offset + len(whole)
        after = TailPosition(offset=offset, line=first + len(lines), head=self._hash(file, offset))
        header = self._skip_lines - first  # where its line is, or without one the first row
        if 0 <= header < len(lines):
            self._header = self._text(lines[header])
            check_rows(self.path, self._header, columns=self.columns)
        above = max(0, header + (self.columns is None or self.columns.header))
        samples = self._read(lines[above:], first + above + 1)
        self.place = after
        return samples

    def _read(self, lines: list[bytes], first: int) -> tuple[Sample, ...]:
        """Read rows together, or one by one where one of them is bad."""
        if not any(line.strip() for line in lines):
            return ()
        try:
            return self._samples(b"".join(lines), first_line=2)
        except RecordError:
            samples = list[Sample]()
            for number, line in enumerate(lines, start=first):
                try:
                    samples += self._samples(line, first_line=number) if line.strip() else ()
                except RecordError as error:
                    self.refuse(f"{self.path}, line {number}", line, str(error))
            return tuple(samples)

    def _samples(self, rows: bytes, *, first_line: int) -> tuple[Sample, ...]:
        record = read_rows(
            self.path,
            self._header,
            self._text(rows),
            columns=self.columns,
            first_line=first_line,
            stream=self.stream,
        )
        return tuple(record.samples())

    @property
    def _skip_lines(self) -> int:
        return 0 if self.columns is None else self.columns.skip_lines

    def _text(self, content: bytes) -> str:
        encoding = "utf-8" if self.columns is None else self.columns.encoding
        try:
            text = content.decode("utf-8-sig" if encoding == "utf-8" else encoding)
        except UnicodeDecodeError as error:
            raise RecordError(f"{self.path}: it is not {encoding.upper()} text.") from error
        if "\0" in text:
            raise RecordError(f"{self.path}: there is a NUL character, so this is no text.")
        return text

    def _hash(self, file: BinaryIO, offset: int) -> str:
        if not offset:
            return ""
        file.seek(0)
        return hashlib.blake2b(file.read(min(offset, _HEAD)), digest_size=8).hexdigest()
