"""Every call of the API, from the request to the answer."""
