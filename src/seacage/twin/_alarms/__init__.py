"""Alarms as OPC UA Part 9 and ISA-18.2 have them: limits, life, texts and key figures."""

from seacage.twin._alarms._alarm import Action, Alarm, Changed, Happened, Limit, Number
from seacage.twin._alarms._conditions import measured_loads, numbers
from seacage.twin._alarms._kpi import AlarmKpi, alarm_kpi
from seacage.twin._alarms._lifecycle import (
    acknowledge,
    evaluate,
    put_in_service,
    remark,
    shelve,
    take_out_of_service,
    unshelve,
)
from seacage.twin._alarms._policy import USUAL, AlarmPolicy
from seacage.twin._alarms._text import AlarmText, described

__all__ = [
    "USUAL",
    "Action",
    "Alarm",
    "AlarmKpi",
    "AlarmPolicy",
    "AlarmText",
    "Changed",
    "Happened",
    "Limit",
    "Number",
    "acknowledge",
    "alarm_kpi",
    "described",
    "evaluate",
    "measured_loads",
    "numbers",
    "put_in_service",
    "remark",
    "shelve",
    "take_out_of_service",
    "unshelve",
]
