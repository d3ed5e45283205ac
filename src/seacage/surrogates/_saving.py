"""Fitted models to plain settings and arrays, and back; nothing executable is stored."""

from collections.abc import Mapping
from typing import get_args

import numpy as np

from seacage.conventions import ModelError
from seacage.surrogates._arrays import Arrays, Settings, setting
from seacage.surrogates._gcn._gcn import FittedGCN
from seacage.surrogates._gp import FittedGaussianProcess
from seacage.surrogates._loads._load_gp import FittedLoadGP
from seacage.surrogates._loads._motion_gp import FittedMotionGP
from seacage.surrogates._multifidelity._nargp import FittedNARGP
from seacage.surrogates._prediction import Predicts
from seacage.surrogates._shape._pca import FittedPcaGP
from seacage.surrogates._shape._shape_gp import FittedShapeGP
from seacage.surrogates._tables._table import Table

Fitted = (
    FittedGaussianProcess
    | FittedGCN
    | FittedLoadGP
    | FittedMotionGP
    | FittedNARGP
    | FittedPcaGP
    | FittedShapeGP
    | Table
)
"""Any fitted model that can be saved."""


def encode(fitted: Fitted) -> tuple[Settings, Arrays]:
    """A fitted model as values for JSON and float64 arrays by name.

    ``fitted``: any fitted model of this room, or a table of one. A view of a model (an output, a
    coordinate) is made again from its whole; a NARGP on a lent level 1 leaves that level out.
    """
    return fitted.to_arrays()


def decode(
    settings: Mapping[str, object],
    arrays: Mapping[str, np.ndarray],
    *,
    lower: Predicts | None = None,
) -> Fitted:
    """The fitted model that was encoded.

    Raises ModelError: of a kind that this version does not know, or with a part missing or damaged.

    ``settings``, ``arrays``: as ``encode`` gave them.
    ``lower``: level 1 of a NARGP that had it lent.
    """
    model = setting(settings, "model", str)
    if model == FittedNARGP.MODEL:
        return FittedNARGP.from_arrays(settings, arrays, lower=lower)
    for kind in get_args(Fitted):
        if model == kind.MODEL:
            return kind.from_arrays(settings, arrays)
    raise ModelError(f"The saved model is a {model!r}, which this version does not know.")
