"""OGC SensorThings, read only: its entities, the options of a query, and the calls."""
