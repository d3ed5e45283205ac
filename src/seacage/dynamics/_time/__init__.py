"""A cage as time goes on: simulated in one sea state, or followed through the weather."""
