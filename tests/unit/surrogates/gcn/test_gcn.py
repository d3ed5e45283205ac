"""The graph convolutional network as a user meets it."""

import json
import subprocess
import sys

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError, ModelError
from seacage.surrogates import GCN, FittedGCN, current_features, decode, encode
from seacage.surrogates._gcn._gcn import _draw_held_out
from seacage.testing import stand_in_campaign, stand_in_seas

CAGE = Cage.named("ace").altered(mesh={"spokes": 6})
ACE = Cage.named("ace")


def shapes(cases: int, *, seed: int) -> tuple[np.ndarray, np.ndarray]:
    seas = stand_in_seas(cases, seed=seed)
    x = current_features(np.array([sea.current_velocity for sea in seas]))
    return x, stand_in_campaign(CAGE, seas).node_position


X, SHAPES = shapes(120, seed=0)


@pytest.fixture(scope="module")
def modal() -> FittedGCN:
    return GCN(cage=CAGE, epochs=150).fit(X, SHAPES)


@pytest.fixture(scope="module")
def paper() -> FittedGCN:
    return GCN(cage=CAGE, kind="paper", epochs=60).fit(X, SHAPES)


def miss(fitted: FittedGCN) -> float:
    x, truth = shapes(60, seed=1)
    return float(np.abs(fitted.predict(x).mean - truth).mean())


@pytest.mark.slow
def test_the_papers_network_learns_to_lean(paper: FittedGCN) -> None:
    still = float(np.abs(SHAPES - SHAPES.mean(axis=0)).mean())
    assert miss(paper) < 0.75 * still


@pytest.mark.slow
def test_the_modal_network_beats_the_papers(modal: FittedGCN, paper: FittedGCN) -> None:
    assert miss(modal) < 0.5 * miss(paper)


@pytest.mark.parametrize("kind", ["modal", pytest.param("paper", marks=pytest.mark.slow)])
def test_two_sigma_hold_most_unseen_shapes(kind: str, request: pytest.FixtureRequest) -> None:
    x, truth = shapes(60, seed=1)
    answer = request.getfixturevalue(kind).predict(x, noisy=True)
    inside = np.mean(np.abs(truth - answer.mean) <= 1.96 * answer.std)
    assert inside > 0.85  # twelve held-out cases know a 95 % quantile to about 6 %


def test_the_papers_weights_rise_at_layer_6_and_are_highest_at_the_tip() -> None:
    gcn = GCN(cage=ACE, kind="paper")
    weight = gcn._weight(gcn._graph())
    layers = weight[:320].reshape(10, 32)
    assert (layers[:5] == layers[0, 0]).all()
    assert (layers[5:] == 2.0 * layers[0, 0]).all()
    assert weight[320] == 4.0 * layers[0, 0]
    assert weight.mean() == pytest.approx(1.0)


def test_a_cage_and_its_edges_are_the_same_net(modal: FittedGCN) -> None:
    by_hand = GCN(edges=CAGE.edges, rest_position=CAGE.design_position, epochs=3)
    by_cage = GCN(cage=CAGE, epochs=3)
    answers = [gcn.fit(X, SHAPES, seed=4).predict(X[:5]).mean for gcn in (by_hand, by_cage)]
    np.testing.assert_array_equal(*answers)


def test_cases_of_ones_own_can_be_held_out() -> None:
    x, truth = shapes(12, seed=2)
    fitted = GCN(cage=CAGE, epochs=3).fit(X[:108], SHAPES[:108], validation=(x, truth))
    assert (len(fitted.off.train), len(fitted.off.held_out)) == (108, 12)
    kept = fitted.off.held_out * fitted.network.scaling.spread + fitted.network.scaling.centre
    np.testing.assert_allclose(kept, x, atol=1e-12)  # roundings


@pytest.mark.parametrize(("share", "expected"), [(None, 12), (0.25, 30), (0.001, 2)])
def test_the_share_held_out_is_what_was_requested(share: float | None, expected: int) -> None:
    held_out = _draw_held_out(120, share, seed=0)
    assert len(set(held_out.tolist())) == expected
    assert set(held_out.tolist()) <= set(range(120))


def test_another_seed_is_another_network() -> None:
    one, other = (GCN(cage=CAGE, epochs=3).fit(X, SHAPES, seed=seed) for seed in (0, 1))
    assert np.abs(one.predict(X).mean - other.predict(X).mean).max() > 1e-3


def test_a_net_that_never_moves_is_learned() -> None:
    still = np.tile(CAGE.design_position, (120, 1, 1))
    answer = GCN(cage=CAGE, epochs=3).fit(X, still).predict(X)
    # Rounding noise of the mean shape is all that there is to learn.
    np.testing.assert_allclose(answer.mean, still, atol=1e-9)
    assert answer.std.max() < 1e-6


def test_many_rows_answer_as_a_few(modal: FittedGCN) -> None:
    whole = modal.predict(X).mean
    np.testing.assert_allclose(modal.predict(X[100:]).mean, whole[100:], atol=1e-9)


def test_a_saved_network_answers_the_same_where_there_is_no_jax(modal: FittedGCN, tmp_path) -> None:
    settings, arrays = encode(modal)
    np.savez(tmp_path / "arrays.npz", x=X, answer=modal.predict(X).mean, **arrays)
    (tmp_path / "settings.json").write_text(json.dumps(settings))
    code = """
import json, sys
sys.modules.update(jax=None, optax=None)
import numpy as np
from seacage.surrogates import decode
arrays = dict(np.load("arrays.npz"))
x, answer = arrays.pop("x"), arrays.pop("answer")
fitted = decode(json.load(open("settings.json")), arrays)
np.testing.assert_array_equal(fitted.predict(x).mean, answer)
"""
    subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path)


def test_training_without_jax_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    import seacage.surrogates._gcn as wing

    monkeypatch.setitem(sys.modules, "jax", None)
    monkeypatch.delitem(sys.modules, "seacage.surrogates._gcn._training", raising=False)
    monkeypatch.delattr(wing, "_training", raising=False)
    with pytest.raises(InputError, match=r"needs jax.*pip install 'seacage\[gcn\]'"):
        GCN(cage=CAGE).fit(X, SHAPES)


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"cage": None}, "the net is not clear"),
        ({"edges": ACE.edges}, "the net is not clear"),
        ({"cage": None, "edges": ACE.edges}, "the net is not clear"),
        ({"epochs": 0}, "epochs = 0 is not above 0"),
        ({"learning_rate": -1.0}, "learning_rate = -1 is not above 0"),
        ({"node_weight": np.ones(4)}, "node_weight must be 321 finite numbers"),
        ({"node_weight": np.zeros(321)}, "not all 0"),
    ],
)
def test_a_network_that_cannot_be_is_refused(changed: dict, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        GCN(**{"cage": ACE} | changed)


@pytest.mark.parametrize(
    ("rows", "validation", "sentence"),
    [
        (3, None, "of 3 cases 2 are held out"),
        (20, 0.95, "of 20 cases 19 are held out"),
        (20, 0.0, r"validation = 0.0 is neither a share"),
        (20, 1.5, r"validation = 1.5 is neither a share"),
        (20, (X[:5, :2], SHAPES[:5]), "validation has 2 features per row, x has 3"),
        (20, (X[:5], SHAPES[:4]), "5 rows of x but 4 of outputs"),
    ],
)
def test_cases_that_do_not_fit_are_refused(rows: int, validation, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        GCN.fit.__wrapped__(GCN(cage=CAGE), X[:rows], SHAPES[:rows], validation=validation)


def test_shapes_of_another_net_are_refused() -> None:
    with pytest.raises(InputError, match="shapes have 61 nodes, but the graph has 321"):
        GCN(cage=ACE).fit(X, SHAPES)


def test_a_saved_network_of_an_unknown_kind_is_refused(modal: FittedGCN) -> None:
    settings, arrays = encode(modal)
    with pytest.raises(ModelError, match="kind 'gat', which this version does not know"):
        decode(settings | {"kind": "gat"}, arrays)


def test_a_saved_network_with_an_impossible_edge_is_refused(modal: FittedGCN) -> None:
    settings, arrays = encode(modal)
    with pytest.raises(ModelError, match="The saved GCN is damaged"):
        decode(settings, arrays | {"edges": arrays["edges"] + 1e6})


def test_a_saved_spread_that_is_all_noise_is_refused(modal: FittedGCN) -> None:
    settings, arrays = encode(modal)
    with pytest.raises(ModelError, match="more than all of its spread noise"):
        decode(settings, arrays | {"noise": arrays["noise"] + 1.0})
