"""The study of the paper's experiment: its claims against this project's own numbers."""
