"""A graph convolutional network over a cage's nodes."""
