"""Files of predictions are checked, and a truth is opened for those alone that were noted."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.studies._bench._seal import note_hashes, open_truth, read_predictions

SHAPES = {"mean_kn": (4, 2), "sd_kn": (4, 2), "raised": (3, 5, 9)}
MEAN = np.ones((4, 2))


def written(path, **arrays):
    np.savez(path, **arrays)
    return path


def test_a_file_of_predictions_is_read_with_what_it_has(tmp_path):
    path = written(tmp_path / "a.npz", mean_kn=MEAN, raised=np.zeros((3, 5, 9), dtype=bool))
    found = read_predictions(path, SHAPES)
    assert set(found) == {"mean_kn", "raised"}
    np.testing.assert_array_equal(found["mean_kn"], MEAN)


@pytest.mark.parametrize(
    ("arrays", "sentence"),
    [
        ({"mean_kn": MEAN[:3]}, r"float64 of shape \(3, 2\); numbers of shape \(4, 2\)"),
        ({"mean_kn": MEAN * np.nan}, "not finite"),
        ({"mean_kn": MEAN, "sd_kn": 0.0 * MEAN}, "not above 0 kN"),
        ({"sd_kn": MEAN}, r"sd_kn \[kN\] stands without mean_kn"),
        ({"mean": MEAN}, "'mean' is none of mean_kn, sd_kn, raised"),
        ({"mean_kn": np.full((4, 2), "1")}, "numbers of shape"),
        ({"mean_kn": np.full((4, 2), None)}, "no file of predictions"),
    ],
)
def test_what_cannot_be_scored_is_refused_in_a_sentence(tmp_path, arrays, sentence):
    with pytest.raises(InputError, match=sentence):
        read_predictions(written(tmp_path / "a.npz", **arrays), SHAPES)


@pytest.mark.parametrize("content", [b"", b"text", b"PK\x03\x04 no zip"])
def test_a_file_that_is_no_npz_is_refused(tmp_path, content):
    (tmp_path / "a.npz").write_bytes(content)
    with pytest.raises(InputError, match="no file of predictions"):
        read_predictions(tmp_path / "a.npz", SHAPES)


def test_the_truth_is_opened_for_the_predictions_that_were_noted_and_no_others(tmp_path):
    sealed = written(tmp_path / "sealed.npz", tension_kn=MEAN)
    files = {"mine": written(tmp_path / "mine.npz", mean_kn=MEAN)}
    ledger = tmp_path / "predictions.json"
    with pytest.raises(InputError, match="mine for tame-1-ab are not those whose hash was noted"):
        open_truth(sealed, ledger, files, "tame-1-ab")
    note_hashes(ledger, {"tame-1-ab": files})
    truth = open_truth(sealed, ledger, files, "tame-1-ab")
    np.testing.assert_array_equal(truth["tension_kn"], MEAN)
    written(files["mine"], mean_kn=1.01 * MEAN)
    with pytest.raises(InputError, match="Run the study again"):
        open_truth(sealed, ledger, files, "tame-1-ab")
