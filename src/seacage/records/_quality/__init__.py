"""Quality control: its tests, their limits, and the one check by them."""
