"""Make a release: `python -m tools.release 0.2.0`, or `make release VERSION=0.2.0`.

All is done in a clone beside the repository, from what is committed alone: the version is set,
the changelog gathered, wheel, source and site are built, the release is committed and tagged, and
the next development version is opened. Only when all of that has worked does the branch take
both commits and the tag, and `dist/` the files. Nothing is uploaded; the last lines say how.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import zipfile
from datetime import UTC, date, datetime
from pathlib import Path
from shutil import copy2, make_archive

from tools.changelog import fragments, gather

ROOT = Path(__file__).parents[1]
VERSION = re.compile(r'(?m)^version = "(.+)"$')


class ReleaseError(Exception):
    """Why no release is made, and what to do."""


def git(root: Path, *words: str) -> str:
    """What a command of git prints."""
    done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ReleaseError(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout.strip()


def check(root: Path, version: str) -> None:
    """Refuse what cannot be a release."""
    if not re.fullmatch(r"\d+\.\d+\.\d+", version):
        raise ReleaseError(f"{version!r} is no version of a release. Give three numbers, as 0.2.0.")
    now = present_version(root)
    if numbers(version) < numbers(now):
        raise ReleaseError(f"{version} is older than {now}, which pyproject.toml has.")
    if git(root, "status", "--porcelain"):
        raise ReleaseError("The tree has changes that are not committed. Commit or stash them.")
    if git(root, "tag", "--list", f"v{version}"):
        raise ReleaseError(f"There is a tag v{version} already. Choose the next version.")
    if not fragments(root):
        raise ReleaseError("changes/ has no fragment: there is nothing to release.")


def present_version(root: Path) -> str:
    """The version that pyproject.toml has."""
    found = VERSION.search((root / "pyproject.toml").read_text())
    if found is None:
        raise ReleaseError("pyproject.toml has no line with a version.")
    return found[1]


def numbers(version: str) -> tuple[int, ...]:
    """The three numbers of a version, to compare."""
    return tuple(int(one) for one in version.split(".")[:3])


def set_version(root: Path, version: str, day: date | None) -> None:
    """Write the version into pyproject.toml and CITATION.cff, there with a release's date."""
    project, citation = root / "pyproject.toml", root / "CITATION.cff"
    project.write_text(VERSION.sub(f'version = "{version}"', project.read_text(), count=1))
    text = re.sub(r"(?m)^date-released: .*\n", "", citation.read_text())
    dated = f"\ndate-released: {day}" if day else ""
    citation.write_text(re.sub(r"(?m)^version: .*$", f"version: {version}{dated}", text))


def build(clone: Path, version: str) -> None:
    """Build wheel, source and site into the clone's dist/; the wheel's build makes the kernel."""
    python = [sys.executable, "-m"]
    run(clone, *python, "hatchling", "build", "-d", "dist")
    check_wheel(next((clone / "dist").glob("*.whl")))
    run(
        clone,
        *python,
        "sphinx",
        "-W",
        "--keep-going",
        "-q",
        "-d",
        "dist/.trees",
        "docs",
        "dist/site",
    )
    make_archive(str(clone / f"dist/seacage-{version}-site"), "zip", clone / "dist/site")


def run(clone: Path, *words: str) -> None:
    """Run a step with the clone's own code, its output shown."""
    own = os.environ | {"PYTHONPATH": str(clone / "src")}
    if subprocess.run(words, cwd=clone, env=own, check=False).returncode:
        raise ReleaseError(f"{' '.join(words[1:])} failed, see above. Nothing was released.")


def check_wheel(wheel: Path) -> None:
    """Refuse a wheel without its kernel or its page, with which an install would do."""
    names = zipfile.ZipFile(wheel).namelist()
    for part in ("seacage/dynamics/_kernel/_kernel_", "seacage/service/page/index.html"):
        if not any(name.startswith(part) for name in names):
            raise ReleaseError(f"{wheel.name} has no {part}…; install a C compiler and Node.")


def release(root: Path, version: str, day: date) -> list[Path]:
    """Make the release and answer with the files that were built."""
    check(root, version)
    branch = git(root, "rev-parse", "--abbrev-ref", "HEAD")
    major, minor, _ = numbers(version)
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "seacage"
        git(root, "clone", "--quiet", "--no-hardlinks", "--branch", branch, str(root), str(clone))
        for key in ("user.name", "user.email"):
            git(clone, "config", key, git(root, "config", key))
        set_version(clone, version, day)
        gather(clone, version, day)
        build(clone, version)
        git(clone, "commit", "--quiet", "--all", "-m", f"Release {version}")
        git(clone, "tag", "--annotate", f"v{version}", "-m", f"seacage {version}")
        set_version(clone, f"{major}.{minor + 1}.0.dev0", None)
        git(clone, "commit", "--quiet", "--all", "-m", f"Open {major}.{minor + 1}.0")
        git(root, "pull", "--quiet", "--ff-only", "--tags", str(clone), branch)
        (root / "dist").mkdir(exist_ok=True)
        built = sorted(path for path in (clone / "dist").iterdir() if path.is_file())
        return [Path(copy2(path, root / "dist")) for path in built]


def main() -> None:
    """Read the command line, make the release and say what is left to do."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("version", help="three numbers, as 0.2.0")
    version = parser.parse_args().version
    try:
        built = release(ROOT, version, datetime.now(UTC).date())
    except ReleaseError as error:
        sys.exit(f"release: {error}")
    print(f"Committed and tagged v{version}, and opened the next version. In dist/:")
    print(*(f"  {path.name}" for path in built), sep="\n")
    print("Nothing has been uploaded. If all is as it should be:")
    print(f"  git push --atomic origin HEAD v{version}")
    print(f"  twine upload dist/seacage-{version}.tar.gz, and the wheel once auditwheel has")
    print("  made it one for many systems: as it is, it runs on systems like this one")
    print("Else take it back, before anything is pushed:")
    print(f"  git tag --delete v{version} && git reset --hard HEAD~2")


if __name__ == "__main__":
    main()
