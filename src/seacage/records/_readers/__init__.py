"""Readers of files: column maps, tables, NetCDF, and the wizard that inspects foreign ones."""

from seacage.records._readers._cf import NetcdfMap
from seacage.records._readers._column_map import Column, ColumnMap
from seacage.records._readers._csv import check_rows, read_rows
from seacage.records._readers._inspect import Inspection, inspect_file
from seacage.records._readers._netcdf import read_netcdf, write_record
from seacage.records._readers._reader import known_map, read_map, read_record
from seacage.records._readers._shipped import shipped_maps

__all__ = [
    "Column",
    "ColumnMap",
    "Inspection",
    "NetcdfMap",
    "check_rows",
    "inspect_file",
    "known_map",
    "read_map",
    "read_netcdf",
    "read_record",
    "read_rows",
    "shipped_maps",
    "write_record",
]
