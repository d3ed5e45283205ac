"""How samples come in and alarms go out: MQTT, HTTP, files, and what a buoy's own end does."""
