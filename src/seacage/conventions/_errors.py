"""The errors that seacage raises; each message says what, why not, and what to do."""


class SeacageError(Exception):
    """Anything that seacage refuses to do, in one clear sentence."""


class InputError(SeacageError, ValueError):
    """A value at a door is impossible, out of range or has no unit."""


class NonsenseError(InputError):
    """A file that can be read, and says what cannot be; a command that was given it ends with 2."""


class RecordError(InputError):
    """A file's structure is wrong, so that none of it can be trusted."""


class ModelError(SeacageError):
    """A saved model is damaged, foreign or of a version that this one cannot read."""
