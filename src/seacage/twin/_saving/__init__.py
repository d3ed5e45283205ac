"""A twin's folder: settings, arrays, the manifest that seals them and its signature."""

from seacage.twin._saving._folder import read_folder, write_folder
from seacage.twin._saving._parts import restored, saved
from seacage.twin._saving._signature import read_key

__all__ = ["read_folder", "read_key", "restored", "saved", "write_folder"]
