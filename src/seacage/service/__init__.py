"""Wires: command line, HTTP, WebSocket, clock and settings."""

from seacage.service._cli import main

__all__ = ["main"]
