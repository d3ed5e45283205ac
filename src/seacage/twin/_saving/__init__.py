"""A twin's folder: settings, arrays, the manifest that seals them and its signature."""

from seacage.twin._saving._folder import read_folder, read_key, write_folder
from seacage.twin._saving._parts import from_parts, to_parts

__all__ = ["from_parts", "read_folder", "read_key", "to_parts", "write_folder"]
