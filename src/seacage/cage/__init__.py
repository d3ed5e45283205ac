"""The cage: collar, netting, sinker tube, bridles and their node graph."""

__all__: list[str] = []
