"""The study of the two fidelities: how they differ, and what is left without a difference."""
