"""Our physics against published numbers, closed forms and other programs, in one table."""

from validation._row import Kind, Row, Section

__all__ = ["Kind", "Row", "Section"]
