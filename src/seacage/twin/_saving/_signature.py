"""Signatures of twins: the holder of a site's key decides which twins it may serve."""

import hashlib
import hmac
from pathlib import Path

from seacage.conventions import InputError, read_bytes

_LEAST, _MOST = 16, 4096  # bytes of a key


def read_key(path: Path | str) -> bytes:
    """Read a key that twins are signed with; every byte of the file counts.

    Raises
    ------
    InputError
        No such file, one that others than its owner may read, too short or too long a one.
    """
    key = read_bytes(path, most=_MOST)
    rights = Path(path).stat().st_mode & 0o777
    if rights & 0o077:
        raise InputError(
            f"The key {path} has the rights {rights:o}, so others than its owner may use it. "
            f"Say: chmod 600 {path}, and make a new key if it has been so for long."
        )
    if len(key) < _LEAST:
        raise InputError(
            f"The key {path} has {len(key)} bytes, and fewer than {_LEAST} can be "
            "guessed. Make one of random bytes, such as by: openssl rand -hex 32."
        )
    return key


def signature(key: bytes, manifest: bytes) -> bytes:
    """Sign a manifest, and so all files that it has the sums of: a line of HMAC-SHA256."""
    return hmac.new(key, manifest, hashlib.sha256).hexdigest().encode() + b"\n"


def is_signed(key: bytes, manifest: bytes, signed: bytes) -> bool:
    """Whether a signature is that of a manifest, compared in constant time."""
    return hmac.compare_digest(signature(key, manifest), signed)
