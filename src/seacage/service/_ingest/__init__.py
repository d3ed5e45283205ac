"""How samples reach a cage: by MQTT, and from files that a logger appends to."""
