"""A database of the store: its tables and rows, in SQLite or PostgreSQL."""
