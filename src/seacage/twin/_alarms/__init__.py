"""Alarms as OPC UA Part 9 and ISA-18.2 have them: limits, life, texts and key figures."""
