"""Files of every format that is read, and ways in which such files break."""

import json

import numpy as np

from seacage.conventions import Origin
from seacage.records import NetcdfMap, Record, shipped_maps, write_record

START = np.datetime64("2018-01-26T00:00:00", "us")
SIZE = 24
HUGE = (
    "1e308",
    "-1e308",
    "1e400",
    "-inf",
    "9" * 40,
    "-99999",
    "1e6",
    "0x7fffffff",
    "1_000_000",
    "１２３４５６７８９",  # full-width digits, which Python's float reads
    "1e",
    "+-1",
    "9" * 400,
)
ENDS = ("\n", "\r\n", "\r", "\n\n", "\r\r\n", "\x0b", "\x0c", "\x85", "\u2028", "\x1c")


def _numbers():
    """A tide and a sea, rounded as buoys round, with directions all round the compass."""
    hours = np.arange(SIZE)
    speed = np.round(30.0 + 25.0 * np.sin(hours / 3.0), 1)
    to = np.round((40.0 + 17.0 * hours) % 360.0)
    hs = np.round(1.5 + 0.6 * np.sin(hours / 9.0), 2)
    tp = np.round(7.5 + 1.5 * np.cos(hours / 7.0), 1)
    return speed, to, hs, tp


def _tables():
    speed, to, hs, tp = _numbers()
    times = [str(t)[:19] for t in START + np.arange(SIZE) * np.timedelta64(1, "h")]
    rows = list(zip(times, speed, to, hs, tp, strict=True))
    blanks = str.maketrans("-T:", "   ")
    ndbc = [
        f"{t[:14].translate(blanks)}50 120  5.0 {h:5.2f} {p:5.1f} {d:3.0f} 1016.5"
        for t, _, d, h, p in rows
    ]
    answer = [
        {"t": t.replace("T", " ")[:16], "s": str(s), "d": f"{d:.0f}", "b": "4"}
        for t, s, d, _, _ in rows
    ]
    return {
        "buoy.csv": "\n".join(
            [
                "time,speed_cm_s,direction_to_deg",
                *(f"{t}Z,{s},{d:.0f}" for t, s, d, _, _ in rows),
                "",
            ]
        ),
        "waves.csv": "\n".join(
            [
                "time,WVHT,DPD,MWD,WSPD,WDIR",
                *(f"{t},{h},{p},{d},1.7,222.0" for t, _, d, h, p in rows),
                "",
            ]
        ),
        "46097.txt": "\n".join(
            [
                "#YY  MM DD hh mm WDIR WSPD  WVHT   DPD MWD   PRES",
                "#yr  mo dy hr mn degT m/s      m   sec degT   hPa",
                *ndbc,
                "",
            ]
        ),
        "house.csv": "\n".join(
            [
                "time,current_speed_m_s,current_to_deg,hs_m,tp_s",
                *(f"{t}+01:00,{s / 100:.3f},{d},{h},{p}" for t, s, d, h, p in rows),
                "",
            ]
        ),
        "coops.json": json.dumps({"metadata": {"id": "s08010"}, "data": answer}, indent=0) + "\n",
    }


TABLES = {name: text.encode() for name, text in _tables().items()}
MAPS = {"coops.json": shipped_maps()["coops_current_metric_gmt"]}


def stored_streams(folder):
    """A stream that seacage wrote and a foreign one, as bytes, with what reads them."""
    import xarray

    speed, to, hs, tp = _numbers()
    time = START + np.arange(SIZE) * np.timedelta64(1, "h")
    values = {"current_speed_m_s": speed / 100.0, "current_to_deg": to}
    write_record(
        Record(stream="buoy-1", time=time, values=values, origin=Origin.MEASURED), folder / "own.nc"
    )
    names = {
        "hs": (hs, "sea_surface_wave_significant_height", "m"),
        "tp": (tp, "sea_surface_wave_period_at_variance_spectral_density_maximum", "s"),
        "dir": (to, "sea_surface_wave_to_direction", "degree"),
    }
    foreign = xarray.Dataset(
        {
            name: ("time", column, {"standard_name": standard, "units": units})
            for name, (column, standard, units) in names.items()
        },
        coords={"time": ("time", np.arange(SIZE), {"units": "hours since 2018-01-26 00:00:00"})},
    )
    foreign.to_netcdf(folder / "foreign.nc", engine="h5netcdf")
    return {
        "own.nc": ((folder / "own.nc").read_bytes(), None),
        "foreign.nc": ((folder / "foreign.nc").read_bytes(), NetcdfMap(origin=Origin.COMPUTED)),
    }


# --- ways to break a table ---------------------------------------------------------------------


def cut(random, content):
    return content[: random.integers(len(content))]


def head_lost(random, content):
    return content[random.integers(1, len(content)) :]


def swapped_columns(random, content):
    """Two columns' cells change places, with their names or without."""
    text = content.decode()
    if text.startswith("{"):
        one, other = random.choice(["t", "s", "d", "b"], size=2, replace=False)
        text = text.replace(f'"{one}":', '"?":').replace(f'"{other}":', f'"{one}":')
        return text.replace('"?":', f'"{other}":').encode()
    lines = text.split("\n")
    mark = "," if "," in lines[0] else " "
    rows = [[cell for cell in line.split(mark) if cell] for line in lines]
    a, b = random.choice(min(len(row) for row in rows if row), size=2, replace=False)
    for row in rows[int(random.integers(2)) :]:
        if len(row) > max(a, b):
            row[a], row[b] = row[b], row[a]
    return "\n".join(mark.join(row) for row in rows).encode()


def another_encoding(random, content):
    text = content.decode()
    at = random.integers(len(text))
    high = bytearray(content)
    high[at] |= 0x80
    ways = (
        bytes(high),
        *(text.encode(encoding) for encoding in ("utf-16", "utf-16-le", "utf-32", "cp500")),
        (text[:at] + "°é" + text[at:]).encode("latin-1"),
        *((text[:at] + strange + text[at:]).encode() for strange in ("\ufeff", "\0", "\u200b")),
    )
    return ways[random.integers(len(ways))]


def huge_numbers(random, content):
    lines = content.decode().split("\n")
    at = int(random.integers(1, len(lines) - 1))
    mark = "," if "," in lines[at] else " "
    cells = lines[at].split(mark)
    cells[random.integers(len(cells))] = HUGE[random.integers(len(HUGE))]
    lines[at] = mark.join(cells)
    return "\n".join(lines).encode()


def mixed_line_ends(random, content):
    lines = content.decode().split("\n")
    kinds = ENDS[: random.integers(1, len(ENDS)) + 1]
    return "".join(line + kinds[random.integers(len(kinds))] for line in lines).encode()


def rows_in_disorder(random, content):
    lines = content.decode().split("\n")
    body = lines[2:-1]
    random.shuffle(body)
    return "\n".join([*lines[:2], *body, *body[: random.integers(5)], ""]).encode()


def quoted(random, content):
    text = content.decode()
    at = random.integers(len(text))
    return (text[:at] + random.choice(['"', "'", '""', '","']) + text[at:]).encode()


def other_delimiters(random, content):
    text = content.decode()
    return text.replace(",", str(random.choice([";", "\t", "|", ", ", ",,"]))).encode()


def pasted_twice(random, content):
    return content + (content if random.integers(2) else b"\n\n" + content[5:])


def emptied_cells(random, content):
    lines = content.decode().split("\n")
    at = int(random.integers(1, len(lines) - 1))
    cells = lines[at].split(",")
    cells[random.integers(len(cells))] = str(random.choice(["", " ", "NaN", "-", "n/a", "#REF!"]))
    lines[at] = ",".join(cells)
    return "\n".join(lines).encode()


MUTATIONS = (
    cut,
    head_lost,
    swapped_columns,
    another_encoding,
    huge_numbers,
    mixed_line_ends,
    rows_in_disorder,
    quoted,
    other_delimiters,
    pasted_twice,
    emptied_cells,
)
WHOLE = {swapped_columns}
"""After these a record is flagged as a whole: which rows are wrong, nobody can say."""


def flipped(random, content):
    """Break a binary file: some bits of it, or its end."""
    if random.integers(3) == 0:
        return cut(random, content)
    broken = bytearray(content)
    for _ in range(int(random.integers(1, 4))):
        broken[random.integers(len(broken))] ^= 1 << int(random.integers(8))
    return bytes(broken)
