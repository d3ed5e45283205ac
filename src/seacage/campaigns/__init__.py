"""Many simulations, planned, run and labelled; and the virtual field."""

__all__: list[str] = []
