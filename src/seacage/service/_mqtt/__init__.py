"""MQTT: brokers, topics, messages, and connections that are made again."""
