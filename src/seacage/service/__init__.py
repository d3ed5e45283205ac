"""Wires: command line, HTTP, WebSocket, clock and settings."""

__all__: list[str] = []
