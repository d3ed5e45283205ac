"""How samples are sent to a service, and its alarms to webhooks."""
