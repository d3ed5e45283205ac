"""Wires: command line, HTTP, WebSocket, clock and settings."""

from seacage.service._cli._app import main

__all__ = ["main"]
