"""Labelled measurements and simulations: their schemas, readers, checks and stores."""

from seacage.records._field import FieldRecord
from seacage.records._keys import KEYS, Key
from seacage.records._record import Record
from seacage.records._sample import Sample
from seacage.records._times import instant, moment

__all__ = ["KEYS", "FieldRecord", "Key", "Record", "Sample", "instant", "moment"]
