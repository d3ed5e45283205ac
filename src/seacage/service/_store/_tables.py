"""The tables of the store, in the words of either database."""

from collections.abc import Mapping

_TABLES = (
    # t is the source's time and t_ingest the service's, in microseconds since 1970 UTC; seq is
    # the source's, -1 where it does not count; readings are {key: [raw value, flag]}, which is
    # text because JSON in a database knows no NaN; remarks say why a value is not good.
    """CREATE TABLE IF NOT EXISTS sample (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    t {integer} NOT NULL,
    seq {integer} NOT NULL,
    readings TEXT NOT NULL,
    remarks TEXT NOT NULL,
    t_ingest {integer} NOT NULL,
    PRIMARY KEY (cage, stream, t, seq)
){parted}""",
    # What usable readings were in each span of width seconds that begins at t.
    """CREATE TABLE IF NOT EXISTS aggregate (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    quantity TEXT NOT NULL,
    width {integer} NOT NULL,
    t {integer} NOT NULL,
    n {integer} NOT NULL,
    mean {real} NOT NULL,
    least {real} NOT NULL,
    most {real} NOT NULL,
    PRIMARY KEY (cage, stream, quantity, width, t)
){keyed}""",
    # Ten minutes whose aggregates are older than their samples, and when those last changed.
    """CREATE TABLE IF NOT EXISTS mark (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    t {integer} NOT NULL,
    touched {integer} NOT NULL,
    PRIMARY KEY (cage, stream, t)
){keyed}""",
    "CREATE INDEX IF NOT EXISTS mark_touched ON mark (touched)",
    # UTC days whose aggregates are final, as samples of theirs were deleted.
    """CREATE TABLE IF NOT EXISTS sealed (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    t {integer} NOT NULL,
    PRIMARY KEY (cage, stream, t)
){keyed}""",
    "CREATE TABLE IF NOT EXISTS alarm_book (cage TEXT PRIMARY KEY, book TEXT NOT NULL){keyed}",
    # How far the intervals of a cage's twin were adapted.
    "CREATE TABLE IF NOT EXISTS adapted (cage TEXT PRIMARY KEY, factors TEXT NOT NULL){keyed}",
    """CREATE TABLE IF NOT EXISTS journal (
    number {counted},
    cage TEXT NOT NULL,
    t {integer} NOT NULL,
    line TEXT NOT NULL
){checked}""",
    "CREATE INDEX IF NOT EXISTS journal_t ON journal (cage, t, number)",
    # Written to see whether the disk takes anything again.
    "CREATE TABLE IF NOT EXISTS trial (id {integer} PRIMARY KEY, t {integer} NOT NULL){keyed}",
)


def tables(words: Mapping[str, str]) -> list[str]:
    """Statements that make the tables where there are none, in a database's words."""
    return [table.format_map(words) for table in _TABLES]
