CREATE TABLE IF NOT EXISTS sample (
    id INTEGER PRIMARY KEY AUTOINCREMENT,  -- in the order in which they were read
    stream TEXT NOT NULL,
    t INTEGER NOT NULL,                    -- microseconds since 1970 UTC
    seq INTEGER NOT NULL,                  -- -1 where it does not count
    said TEXT NOT NULL,
    UNIQUE (stream, t, seq)
) STRICT;
CREATE TABLE IF NOT EXISTS ahead (         -- refused, as their time has not come
    t INTEGER NOT NULL,
    stream TEXT NOT NULL,
    seq INTEGER NOT NULL,
    said TEXT NOT NULL,
    since INTEGER NOT NULL,                -- when first refused
    reason TEXT NOT NULL,
    PRIMARY KEY (t, stream, seq)
) STRICT, WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS ahead_since ON ahead (since);
CREATE TABLE IF NOT EXISTS place (source TEXT PRIMARY KEY, place TEXT NOT NULL) STRICT;
