"""Alarms as OPC UA Part 9 and ISA-18.2 have them: limits, life, texts and key figures."""

from seacage.twin._alarms._alarm import Action, Alarm, AlarmEvent, AlarmInput, Changed, Limit
from seacage.twin._alarms._conditions import alarm_inputs, shackle_loads
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
from seacage.twin._alarms._policy import DEFAULT_LIMITS, AlarmPolicy
from seacage.twin._alarms._text import AlarmText, alarm_text

__all__ = [
    "DEFAULT_LIMITS",
    "Action",
    "Alarm",
    "AlarmEvent",
    "AlarmInput",
    "AlarmKpi",
    "AlarmPolicy",
    "AlarmText",
    "Changed",
    "Limit",
    "acknowledge",
    "alarm_inputs",
    "alarm_kpi",
    "alarm_text",
    "evaluate",
    "put_in_service",
    "remark",
    "shackle_loads",
    "shelve",
    "take_out_of_service",
    "unshelve",
]
