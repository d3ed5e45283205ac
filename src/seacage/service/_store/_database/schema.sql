-- The tables, in the words of either database: those in braces differ.

-- crc is the checksum of all other columns; rows of 0.1.0 have none.
-- t is the source's time and t_ingest the service's, in microseconds since 1970 UTC; seq is
-- the source's, -1 where it does not count; readings are {key: [raw value, flag]}, which is
-- text because JSON in a database knows no NaN; remarks say why a value is not good.
CREATE TABLE IF NOT EXISTS sample (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    t {integer} NOT NULL,
    seq {integer} NOT NULL,
    readings TEXT NOT NULL,
    remarks TEXT NOT NULL,
    t_ingest {integer} NOT NULL,
    crc {integer},
    PRIMARY KEY (cage, stream, t, seq)
){parted};

-- What usable readings were in each span of width seconds that begins at t.
CREATE TABLE IF NOT EXISTS aggregate (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    quantity TEXT NOT NULL,
    width {integer} NOT NULL,
    t {integer} NOT NULL,
    n {integer} NOT NULL,
    mean {real} NOT NULL,
    least {real} NOT NULL,
    most {real} NOT NULL,
    crc {integer},
    PRIMARY KEY (cage, stream, quantity, width, t)
){keyed};

-- Ten minutes whose aggregates are older than their samples, and when those last changed.
CREATE TABLE IF NOT EXISTS mark (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    t {integer} NOT NULL,
    touched {integer} NOT NULL,
    crc {integer},
    PRIMARY KEY (cage, stream, t)
){keyed};

CREATE INDEX IF NOT EXISTS mark_touched ON mark (touched);

-- UTC days whose aggregates are final, as samples of theirs were deleted.
CREATE TABLE IF NOT EXISTS sealed (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    t {integer} NOT NULL,
    crc {integer},
    PRIMARY KEY (cage, stream, t)
){keyed};

CREATE TABLE IF NOT EXISTS alarm_book (
    cage TEXT PRIMARY KEY,
    book TEXT NOT NULL,
    crc {integer}
){keyed};

-- What the quality control remembers of a stream after the sample (t, seq), now and then.
CREATE TABLE IF NOT EXISTS quality (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    t {integer} NOT NULL,
    seq {integer} NOT NULL,
    memory TEXT NOT NULL,
    crc {integer},
    PRIMARY KEY (cage, stream, t, seq)
){keyed};

-- How far the intervals of a cage's twin were adapted, until 0.1.0; then from when on.
CREATE TABLE IF NOT EXISTS adapted (
    cage TEXT PRIMARY KEY,
    factors TEXT NOT NULL,
    crc {integer}
){keyed};

CREATE TABLE IF NOT EXISTS adaptation (
    cage TEXT NOT NULL,
    t {integer} NOT NULL,
    factors TEXT NOT NULL,
    crc {integer},
    PRIMARY KEY (cage, t)
){keyed};

-- From when on intervals were adapted without late samples, and when the last of these came.
CREATE TABLE IF NOT EXISTS refold (
    cage TEXT PRIMARY KEY,
    t {integer} NOT NULL,
    touched {integer} NOT NULL,
    crc {integer}
){keyed};

-- What stretches of time did to the lines of a cage, and from when on each line is counted.
CREATE TABLE IF NOT EXISTS damage (
    cage TEXT NOT NULL,
    t {integer} NOT NULL,
    sums TEXT NOT NULL,
    crc {integer},
    PRIMARY KEY (cage, t)
){keyed};

CREATE TABLE IF NOT EXISTS damage_begin (
    cage TEXT NOT NULL,
    line TEXT NOT NULL,
    t {integer} NOT NULL,
    crc {integer},
    PRIMARY KEY (cage, line, t)
){keyed};

CREATE TABLE IF NOT EXISTS journal (
    number {counted},
    cage TEXT NOT NULL,
    t {integer} NOT NULL,
    line TEXT NOT NULL,
    crc {integer}
){checked};

CREATE INDEX IF NOT EXISTS journal_t ON journal (cage, t, number);

-- How many rows of a kind there are of a stream's UTC day that begins at t.
CREATE TABLE IF NOT EXISTS tally (
    cage TEXT NOT NULL,
    kind TEXT NOT NULL,
    stream TEXT NOT NULL,
    t {integer} NOT NULL,
    n {integer} NOT NULL,
    PRIMARY KEY (cage, kind, stream, t)
){keyed};

-- Written to see whether the disk takes anything again.
CREATE TABLE IF NOT EXISTS trial (id {integer} PRIMARY KEY, t {integer} NOT NULL){keyed};
