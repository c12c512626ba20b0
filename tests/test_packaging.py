"""Packaging: lists that must agree with the folders, and what a built distribution holds."""

import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import venv
import zipfile
from pathlib import Path

import elastolink
import pytest

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
SETUPTOOLS = PROJECT["tool"]["setuptools"]
FOLDERS = {"derive", "docs", "generated", "runtime", "templates", "tests"}
PAGES = {"CHANGELOG.md", "CITATION.cff", "CONTRIBUTING.md", "LICENSE", "README.md"}
FILES = {*PAGES, "MANIFEST.in", "pyproject.toml"}
LEFT_BY_TOOLS = {"build", "dist", "gallery", "__pycache__"}


def tracked() -> list[Path]:
    """Return the files of the project, relative to its root; without git, whatever is there."""
    if (ROOT / ".git").exists() and shutil.which("git"):
        listed = subprocess.run(
            ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        names = {Path(name) for name in listed.split("\0") if name}
        return sorted(name for name in names if (ROOT / name).is_file())
    found = (path.relative_to(ROOT) for path in ROOT.rglob("*") if path.is_file())
    return sorted(
        path
        for path in found
        if not (LEFT_BY_TOOLS & set(path.parts) or path.parts[0].endswith(".egg-info"))
        and not any(part.startswith(".") and part != ".ci" for part in path.parts)
        and path.name not in {"PKG-INFO", "setup.cfg"}
    )


TRACKED = tracked()


def source_packages() -> dict[str, str]:
    """Return each package that the folders hold, with its folder."""
    found = {"elastolink": "runtime/_root"}
    for path in TRACKED:
        packaged = path.parts[0] in FOLDERS - {"docs", "tests"}
        if packaged and path.name == "__init__.py" and path.parts[:2] != ("runtime", "_root"):
            found[".".join(["elastolink", *path.parent.parts])] = path.parent.as_posix()
    return found


def test_the_listed_packages_are_the_folders():
    assert sorted(SETUPTOOLS["packages"]) == sorted(source_packages())
    assert SETUPTOOLS["packages"] == sorted(SETUPTOOLS["packages"])
    mapped = SETUPTOOLS["package-dir"]
    for package, folder in source_packages().items():
        parent = max((p for p in mapped if f"{package}.".startswith(f"{p}.")), key=len)
        rest = package.removeprefix(parent).replace(".", "/")
        assert mapped[parent] + rest == folder
    # Every folder with code is a package.
    holding = {path.parent.as_posix() for path in TRACKED if path.suffix == ".py"}
    code = {name for name in holding if name.split("/")[0] in FOLDERS - {"docs", "tests"}}
    assert code == set(source_packages().values())


def test_only_the_folders_of_the_design_stand_at_the_top():
    visible = [path for path in TRACKED if not path.parts[0].startswith(".")]
    assert {path.parts[0] for path in visible if len(path.parts) > 1} == FOLDERS
    assert {path.name for path in visible if len(path.parts) == 1} == FILES


def test_versions_agree():
    version = PROJECT["project"]["version"]
    assert elastolink.__version__ == version
    assert re.search(rf"^version: {re.escape(version)}$", (ROOT / "CITATION.cff").read_text(), re.M)
    assert f"## {version}" in (ROOT / "CHANGELOG.md").read_text()


def test_the_lock_file_pins_what_bytes_depend_on():
    if not (ROOT / ".ci").exists():
        pytest.skip("a source distribution holds no .ci")
    pins = dict(line.split("==") for line in (ROOT / ".ci" / "lock.txt").read_text().split())
    for name in ("sympy", "mpmath", "numpy", "scipy", "Jinja2", "pytest", "ruff", "mypy"):
        assert re.fullmatch(r"[\d.]+", pins[name])


# Written in pieces, so that this file does not contain what it looks for.
_ABSOLUTE = "|".join(f"/{name}/" for name in ("work", "tmp", "root", "home", "Users", "mnt"))
_PLACES = rf"(?<![\w.:/-])(?:{_ABSOLUTE})|[A-Z]:\\\\Users|127\.0\.0\.1|local(?:host)|py(?:pi)\.org"


def test_no_file_names_a_machine():
    found = []
    for path in TRACKED:
        if path == Path(__file__).relative_to(ROOT):
            continue
        try:
            text = (ROOT / path).read_text()
        except UnicodeDecodeError:
            continue
        found += [f"{path}: {hit.group()}" for hit in re.finditer(_PLACES, text)]
    assert found == []


def test_no_file_is_large_or_empty_by_mistake():
    sizes = {path.as_posix(): (ROOT / path).stat().st_size for path in TRACKED}
    assert [name for name, size in sizes.items() if size == 0] == ["runtime/_root/py.typed"]
    assert [name for name, size in sizes.items() if size > 500_000] == []


def run(*command: object, cwd: Path, **environment: str) -> str:
    done = subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=500,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def clean(tmp_path_factory):
    """Return a copy of the project as a clean clone has it."""
    folder = tmp_path_factory.mktemp("clone") / "elastolink"
    for path in TRACKED:
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / path, folder / path)
    return folder


def _backend(call: str, source: Path, out: Path) -> Path:
    """Call the build backend as a front end does; give what it made."""
    out.mkdir(parents=True, exist_ok=True)
    code = f"from setuptools import build_meta as b; print('made:' + b.{call}({str(out)!r}))"
    return out / run(sys.executable, "-c", code, cwd=source).split("made:")[1].strip()


@pytest.fixture(scope="module")
def sdist(clean):
    pytest.importorskip("setuptools", "77", "pyproject.toml needs setuptools 77")
    return _backend("build_sdist", clean, clean.parent / "dist")


@pytest.fixture(scope="module")
def wheel(sdist):
    """Return the wheel that is built from the source distribution."""
    with tarfile.open(sdist) as archive:
        archive.extractall(sdist.parent / "unpacked", filter="data")
    source = sdist.parent / "unpacked" / sdist.name.removesuffix(".tar.gz")
    return _backend("build_wheel", source, sdist.parent / "wheel")


@pytest.mark.slow
def test_the_source_distribution_holds_the_project(sdist):
    with tarfile.open(sdist) as archive:
        names = [Path(*Path(m.name).parts[1:]) for m in archive.getmembers() if m.isfile()]
    added = {"PKG-INFO", "setup.cfg"}
    held = {n for n in names if n.as_posix() not in added and "egg-info" not in n.parts[0]}
    assert held == {path for path in TRACKED if not path.parts[0].startswith(".")}


@pytest.mark.slow
def test_the_wheel_holds_the_packages_and_their_data_and_nothing_else(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
        meta = {name.partition("/")[2] for name in archive.namelist() if ".dist-info/" in name}
        (record,) = [n for n in archive.namelist() if n.endswith("entry_points.txt")]
        commands = archive.read(record).decode()
    expected = set()
    for package, folder in source_packages().items():
        for path in TRACKED:
            if path.parent.as_posix() == folder and path.suffix != ".pyc":
                expected.add("/".join([*package.split("."), path.name]))
    data = [path for path in TRACKED if path.parts[0] == "runtime" and path.parts[2:3] == ("data",)]
    expected |= {"/".join(["elastolink", *path.parts]) for path in data}
    assert names == expected
    for name in ("py.typed", "__init__.pyi", "generated/manifest.json", "templates/module.py.j2"):
        assert f"elastolink/{name}" in names
    assert {"METADATA", "WHEEL", "RECORD", "entry_points.txt", "licenses/LICENSE"} <= meta
    assert "elastolink = elastolink.runtime.cli:main" in commands
    assert "regenerate-equations = elastolink.derive.regenerate:main" in commands


TRY_OUT = """
import elastolink as el
from elastolink.generated import four_bar_kinematics
scene = el.load_scene("smith_1972_5152_sixteenth_inch")
assert el.floquet_multipliers(scene.system(), speed=30.0).multipliers.shape == (2,)
print(el.__file__)
"""


@pytest.mark.slow
@pytest.mark.parametrize("way", ["wheel", "editable", "strict"])
def test_each_way_of_installing_works(way, clean, wheel, tmp_path):
    """The dependencies come from this interpreter's environment, elastolink from the new one."""
    place = tmp_path / "venv"
    venv.create(place, with_pip=False)
    binaries = place / ("Scripts" if os.name == "nt" else "bin")
    python = binaries / "python"
    here = run(python, "-c", "import site; print(site.getsitepackages()[0])", cwd=tmp_path).strip()
    # Behind the new environment's own packages, those of this interpreter, but elastolink.
    behind = tmp_path / "behind"
    behind.mkdir()
    for folder in {Path(p) for p in sys.path if p.endswith("site-packages")}:
        for entry in folder.iterdir():
            if not entry.name.startswith(("elastolink", "__editable__", "_virtualenv")):
                target = behind / entry.name
                if not target.exists():
                    target.symlink_to(entry)
    (Path(here) / "behind.pth").write_text(f"{behind}\n")
    source = tmp_path / "source"
    shutil.copytree(clean, source)
    options = {"strict": ["--config-settings", "editable_mode=strict"]}.get(way, [])
    what = [wheel] if way == "wheel" else ["--editable", source]
    install = ["install", "--quiet", "--no-deps", "--no-build-isolation", *options, *what]
    run(sys.executable, "-m", "pip", "--python", python, *install, cwd=tmp_path)
    assert str(tmp_path) in run(python, "-c", TRY_OUT, cwd=tmp_path)
    scenes = run(binaries / "elastolink", "scenes", cwd=tmp_path)
    assert "mathieu" in scenes
    cache = {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    run(binaries / "regenerate-equations", "hill_plain", cwd=tmp_path, **cache)
    assert (tmp_path / "cache" / "elastolink" / "modules" / "hill_plain.py").exists()
    run(binaries / "regenerate-equations", cwd=source, **cache)
    again = run(binaries / "regenerate-equations", cwd=source, **cache)
    assert again.startswith(f"nothing to do: all is current in {source / 'generated'}")
