"""Samples, aggregates, alarms and their journal, kept in SQLite or PostgreSQL and in archives."""
