"""Labelled measurements and simulations: their schemas, readers, checks and stores."""

from seacage.records._aligned import Clock, aligned
from seacage.records._campaign import CampaignRecord, export_campaign, read_campaign, write_campaign
from seacage.records._campaign_store import (
    NOT_RUN,
    campaign_results,
    campaign_unsummed,
    campaign_variable,
    create_campaign,
    finish_campaign,
    write_cases,
)
from seacage.records._field import FieldRecord
from seacage.records._history_file import (
    STATISTICS,
    TWINES,
    HistoryRecord,
    read_history,
    write_history,
)
from seacage.records._keys import (
    KEYS,
    NO_MEAN_PERIOD,
    Key,
    bin_keys,
    current_bins,
    is_direction,
    is_mean_period,
    key_of,
    plain_key,
)
from seacage.records._lines import LINES
from seacage.records._quality._check import (
    AHEAD,
    Amendment,
    QualityState,
    Verdict,
    alike,
    amended,
    check_record,
    check_sample,
    is_evaluated,
    is_withdrawn,
    verdicts_on,
    withdrawn,
)
from seacage.records._quality._limits import (
    DEFAULT_LIMITS,
    GROUPS,
    Limits,
    Range,
    Season,
    Steadiness,
    groups_of,
    read_limits,
)
from seacage.records._readers._cf import NetcdfMap
from seacage.records._readers._column_map import Column, ColumnMap, shipped_maps
from seacage.records._readers._csv import check_rows, read_rows
from seacage.records._readers._inspect import Inspection, inspect_file
from seacage.records._readers._netcdf import write_record
from seacage.records._readers._own_readers import Reader
from seacage.records._readers._profiler import ProfilerMap
from seacage.records._readers._reader import known_map, read_map, read_record
from seacage.records._readers._results import read_results
from seacage.records._readers._sea_states import SEA_COLUMNS, read_sea_states, sea_columns
from seacage.records._record import Record
from seacage.records._sample import Sample, check_stream
from seacage.records._times import instant, moment
from seacage.records._truth_file import TrueMeans

__all__ = [
    "AHEAD",
    "DEFAULT_LIMITS",
    "GROUPS",
    "KEYS",
    "LINES",
    "NOT_RUN",
    "NO_MEAN_PERIOD",
    "SEA_COLUMNS",
    "STATISTICS",
    "TWINES",
    "Amendment",
    "CampaignRecord",
    "Clock",
    "Column",
    "ColumnMap",
    "FieldRecord",
    "HistoryRecord",
    "Inspection",
    "Key",
    "Limits",
    "NetcdfMap",
    "ProfilerMap",
    "QualityState",
    "Range",
    "Reader",
    "Record",
    "Sample",
    "Season",
    "Steadiness",
    "TrueMeans",
    "Verdict",
    "aligned",
    "alike",
    "amended",
    "bin_keys",
    "campaign_results",
    "campaign_unsummed",
    "campaign_variable",
    "check_record",
    "check_rows",
    "check_sample",
    "check_stream",
    "create_campaign",
    "current_bins",
    "export_campaign",
    "finish_campaign",
    "groups_of",
    "inspect_file",
    "instant",
    "is_direction",
    "is_evaluated",
    "is_mean_period",
    "is_withdrawn",
    "key_of",
    "known_map",
    "moment",
    "plain_key",
    "read_campaign",
    "read_history",
    "read_limits",
    "read_map",
    "read_record",
    "read_results",
    "read_rows",
    "read_sea_states",
    "sea_columns",
    "shipped_maps",
    "verdicts_on",
    "withdrawn",
    "write_campaign",
    "write_cases",
    "write_history",
    "write_record",
]
