"""Making a release: what is refused, what is written, and that nothing half done stays."""

import subprocess
from datetime import date
from pathlib import Path

import pytest

from tools import changelog
from tools import release as tool

ROOT = Path(__file__).parents[3]
DAY = date(2027, 1, 31)


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A small repository with the files that a release touches."""
    root = tmp_path / "work"
    (root / "changes").mkdir(parents=True)
    (root / "changes/README.md").write_text("# What changed\n")
    (root / "changes/7.feature.md").write_text("Waves break.\n\nSee [it](../docs/cage.md).\n")
    (root / "changes/8.physics.md").write_text("1 kN, before: 2 kN.\n")
    (root / "CHANGELOG.md").write_text("# Changelog\n\nNewest first.\n\n## 0.1.0 (2026-01-01)\n")
    for name in ("pyproject.toml", "CITATION.cff", ".gitignore"):
        (root / name).write_bytes((ROOT / name).read_bytes())
    git(root, "init", "--quiet", "--initial-branch", "main")
    git(root, "config", "user.name", "maintainers")
    git(root, "config", "user.email", "maintainers@example.org")
    git(root, "add", ".")
    git(root, "commit", "--quiet", "-m", "Begin")
    return root


def git(root: Path, *words: str) -> str:
    return subprocess.run(
        ["git", *words], cwd=root, check=True, capture_output=True, text=True
    ).stdout.strip()


def build_little(clone: Path, version: str) -> None:
    """A wheel in name alone, in the place of a build of minutes."""
    (clone / "dist").mkdir()
    (clone / f"dist/seacage-{version}-py3-none-any.whl").write_text(
        tool.present_version(clone) + (clone / "CHANGELOG.md").read_text()
    )


def test_a_release_is_a_commit_a_tag_and_files_and_the_next_version_is_open(
    repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tool, "build", build_little)
    (wheel,) = tool.release(repository, "0.2.0", DAY)
    assert wheel == repository / "dist/seacage-0.2.0-py3-none-any.whl"
    assert wheel.read_text().startswith("0.2.0# Changelog")
    assert git(repository, "log", "--format=%s").splitlines()[:2] == ["Open 0.3.0", "Release 0.2.0"]
    assert git(repository, "rev-list", "-n1", "v0.2.0") == git(repository, "rev-parse", "HEAD~1")
    assert not git(repository, "status", "--porcelain")
    released = git(repository, "show", "v0.2.0:CITATION.cff")
    assert "version: 0.2.0\ndate-released: 2027-01-31" in released
    assert tool.present_version(repository) == "0.3.0.dev0"
    assert "date-released" not in (repository / "CITATION.cff").read_text()
    assert [path.name for path in (repository / "changes").iterdir()] == ["README.md"]
    text = (repository / "CHANGELOG.md").read_text()
    assert text.index("## 0.2.0 (2027-01-31)") < text.index("- 1 kN, before: 2 kN. (#8)")
    assert text.index("#8") < text.index("- See [it](docs/cage.md). (#7)") < text.index("## 0.1.0")


def test_a_build_that_fails_leaves_no_trace(
    repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(clone: Path, version: str) -> None:
        raise tool.ReleaseError("no compiler")

    before = git(repository, "rev-parse", "HEAD")
    monkeypatch.setattr(tool, "build", fail)
    with pytest.raises(tool.ReleaseError, match="no compiler"):
        tool.release(repository, "0.2.0", DAY)
    assert git(repository, "rev-parse", "HEAD") == before
    assert not git(repository, "tag")
    assert not git(repository, "status", "--porcelain")


def spoil(repository: Path, how: str) -> None:
    if how == "tagged":
        git(repository, "tag", "v0.2.0")
    elif how == "changed":
        (repository / "CITATION.cff").write_text("")
    elif how == "empty":
        git(repository, "rm", "--quiet", "changes/7.feature.md", "changes/8.physics.md")
        git(repository, "commit", "--quiet", "-m", "Take them away")


@pytest.mark.parametrize(
    ("version", "how", "why"),
    [
        ("0.2", "", "no version of a release"),
        ("0.2.0.dev0", "", "no version of a release"),
        ("0.1.9", "", "older than"),
        ("0.2.0", "tagged", "a tag v0.2.0 already"),
        ("0.2.0", "changed", "not committed"),
        ("0.2.0", "empty", "nothing to release"),
    ],
)
def test_what_cannot_be_a_release_is_refused(
    repository: Path, version: str, how: str, why: str
) -> None:
    spoil(repository, how)
    with pytest.raises(tool.ReleaseError, match=why):
        tool.release(repository, version, DAY)


def test_every_fragment_of_the_repository_has_an_issue_and_a_type() -> None:
    files = [path for path in (ROOT / "changes").iterdir() if path.name != "README.md"]
    assert len(changelog.fragments(ROOT)) == len(files)
    if files:
        assert changelog.section(ROOT, "Next release").count("\n- ") >= len(files)


def test_a_file_of_changes_without_a_type_is_refused(repository: Path) -> None:
    (repository / "changes/9.surprise.md").write_text("Boo.\n")
    with pytest.raises(ValueError, match="one of removal, physics"):
        changelog.section(repository, "Next release")


def test_a_wheel_without_its_page_is_refused(tmp_path: Path) -> None:
    import zipfile

    with zipfile.ZipFile(tmp_path / "seacage.whl", "w") as wheel:
        wheel.writestr("seacage/dynamics/_kernel/_kernel_native.so", "")
    with pytest.raises(tool.ReleaseError, match="page"):
        tool.check_wheel(tmp_path / "seacage.whl")


def test_the_citation_has_what_its_format_asks_for_and_the_version_of_the_project() -> None:
    lines = (ROOT / "CITATION.cff").read_text().splitlines()
    keys = {line.split(":")[0] for line in lines if line and line[0] not in " -"}
    assert {"cff-version", "message", "title", "authors"} <= keys
    assert "cff-version: 1.2.0" in lines
    assert "  - name: seacage developers" in lines
    assert f"version: {tool.present_version(ROOT)}" in lines
