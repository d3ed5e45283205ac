"""The HTTP interface: every call, from the request to the answer."""
