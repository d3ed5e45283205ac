"""Made-up files in the forms of the public records, which are not ours to copy.

The headers are those of `data/README.md` in the folder of shared records.
"""

from pathlib import Path

import numpy as np

DEPTHS = (0, 5, 10, 15, 20, 25, 30, 40, 50)
PUBLIC = {
    "portsbuoy.csv": "speed_cm_s,direction_to_deg",
    "ndbc.csv": "WVHT,DPD,MWD,WSPD,WDIR",
    "norkyst.csv": ",".join(
        ["zeta_0m", *(f"current_{one}_{z}m" for z in DEPTHS for one in ("speed", "direction"))]
    ),
    "nora10.csv": "HS,TP,TM,DIRP,DIRM,HSw,TPw,DIRPw,HSs,TPs,DIRPs,W10,D10",
}
"""The columns after the time, by a name of our own."""


def public_file(folder: Path, name: str, *, rows: int) -> Path:
    """Write a file of `rows` two-hourly random rows, rounded as those records are."""
    columns = PUBLIC[name].split(",")
    start, step = np.datetime64("2018-01-26T00:00:00"), np.timedelta64(2, "h")
    random = np.random.default_rng(len(columns))
    lines = [f"time,{PUBLIC[name]}"]
    for at in start + step * np.arange(rows):
        values = [
            random.uniform(0.0, 359.0) if column_is_angle(column) else random.uniform(0.1, 1.9)
            for column in columns
        ]
        stamp = f"{at}Z" if name == "portsbuoy.csv" else str(at).replace("T", " ")
        lines.append(",".join([stamp, *(f"{value:.2f}" for value in values)]))
    (folder / name).write_text("\n".join([*lines, ""]))
    return folder / name


def column_is_angle(column: str) -> bool:
    """Whether it is a direction in degrees."""
    return "dir" in column.lower() or column in {"MWD", "D10"}
