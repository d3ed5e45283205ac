"""Readers of files: column maps, tables, NetCDF, and the wizard that inspects foreign ones."""
