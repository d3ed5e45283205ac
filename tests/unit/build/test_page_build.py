"""The page's build knows what is new, takes the Node there is, and never stops an install."""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest


def loaded(place: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(place.stem, place)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def hook(pytestconfig: pytest.Config) -> ModuleType:
    """The build hook of installs and wheels."""
    return loaded(pytestconfig.rootpath / "hatch_build.py")


@pytest.fixture
def page(pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """The page's build, over sources and an output of the test's own."""
    module = loaded(pytestconfig.rootpath / "web" / "build.py")
    web, output = tmp_path / "web", tmp_path / "page"
    for name in ("index.html", "package.json", "src/main.js", "src/style/base.css"):
        place = web / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(name)
    monkeypatch.setattr(module, "WEB", web)
    monkeypatch.setattr(module, "OUTPUT", output)
    monkeypatch.setattr(module, "STAMP", output / "sources.sha256")
    return module


@pytest.fixture
def built(page: ModuleType) -> ModuleType:
    """A page that was built from the sources as they are."""
    page.OUTPUT.mkdir()
    (page.OUTPUT / "index.html").write_text("built")
    page.STAMP.write_text(page.fingerprint())
    return page


def program(folder: Path, name: str, says: str) -> None:
    place = folder / name
    place.write_text(f"#!{sys.executable}\nprint({says!r})\n")
    place.chmod(0o755)


def test_a_page_is_current_until_a_source_changes(built: ModuleType) -> None:
    assert built.is_current()
    (built.WEB / "src" / "main.js").write_text("changed")
    assert not built.is_current()


def test_a_renamed_source_is_a_change(built: ModuleType) -> None:
    (built.WEB / "src" / "main.js").rename(built.WEB / "src" / "other.js")
    assert not built.is_current()


def test_a_page_that_went_missing_is_not_current(built: ModuleType) -> None:
    (built.OUTPUT / "index.html").unlink()
    assert not built.is_current()


def test_what_was_fetched_or_tested_is_no_source(built: ModuleType) -> None:
    for name in ("node_modules/three/three.js", "test/wire.test.js"):
        place = built.WEB / name
        place.parent.mkdir(parents=True)
        place.write_text("anything")
    assert built.is_current()


@pytest.mark.skipif(os.name == "nt", reason="needs programs that are scripts")
@pytest.mark.parametrize(("version", "does"), [("v20.1.0", True), ("v16.20.2", False)])
def test_node_is_taken_from_the_system_where_it_is_new_enough(
    version: str, does: bool, page: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    program(tmp_path, "node", version)
    assert page.system_node() is None, "node without npm does not do"
    program(tmp_path, "npm", "")
    assert (page.system_node() is not None) is does


def test_an_install_goes_on_without_its_page_and_says_why(
    hook: ModuleType, page: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    def refused() -> None:
        raise page.PageError("npm could not reach its registry.")

    monkeypatch.setattr(page, "build", refused)
    monkeypatch.setattr(hook, "page_build", lambda _: page)
    hook.build_page("")
    assert capsys.readouterr().err == (
        "seacage is installed without its page. npm could not reach its registry.\n"
    )


def test_a_wheel_for_another_machine_is_refused_without_its_page(
    hook: ModuleType, page: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused() -> None:
        raise page.PageError("npm could not reach its registry.")

    monkeypatch.setattr(page, "build", refused)
    monkeypatch.setattr(hook, "page_build", lambda _: page)
    with pytest.raises(page.PageError, match="registry"):
        hook.build_page("", needed=True)


def test_an_install_leaves_a_current_page_alone(
    hook: ModuleType, built: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(built, "build", lambda: pytest.fail("it was built again"))
    monkeypatch.setattr(hook, "page_build", lambda _: built)
    hook.build_page("")


def test_a_build_that_fails_reports_the_first_words_of_the_program(
    page: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = "import sys; sys.exit('no such module: three')"
    monkeypatch.setattr(page, "_tools", lambda: ([sys.executable, "-c", script], ["node"]))
    with pytest.raises(page.PageError, match="no such module: three"):
        page.build()
    assert not page.STAMP.exists()


def test_the_lock_names_no_address_and_fits_its_package(pytestconfig: pytest.Config) -> None:
    web = pytestconfig.rootpath / "web"
    assert "http" not in (web / "package-lock.json").read_text()
    tracked = subprocess.run(
        ["git", "ls-files", "src/seacage/service/page"],
        cwd=pytestconfig.rootpath,
        capture_output=True,
        text=True,
        check=False,
    )
    assert not tracked.stdout, "the built page is not committed"
