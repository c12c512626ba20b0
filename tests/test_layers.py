"""Who may import what: walls between folders, layers of rooms; in the source and in processes."""

import ast
import re
import sys
from collections.abc import Callable, Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
from fresh_process import python

ROOT = Path(__file__).parents[1]
FOLDERS = ("derive", "generated", "runtime", "templates")
PACKAGES = {folder: f"elastolink.{folder}" for folder in FOLDERS}
STANDARD = frozenset(sys.stdlib_module_names)
NUMERIC = {"numpy", "scipy"}
# What the run-time side may load inside a function, when it is asked for.
LAZY = """
PIL clarabel matplotlib mpl_toolkits pint tqdm xarray exudyn heyoka numba flint sksundae rainflow
"""

# From bottom to top; `docs/architecture.md` shows the same.
LAYERS = """
core linkages rigid beams systems scenes hill periodic recovery constrained frequencies
stability nonlinear design report sweeps gallery cli
"""


def sources(*folders: str) -> list[Path]:
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]


def package_of(path: Path) -> list[str]:
    """Return the package that holds a source file, as a list of names."""
    parts = list(path.relative_to(ROOT).with_suffix("").parts)
    if parts[:2] == ["runtime", "_root"]:
        return ["elastolink"]
    return ["elastolink", *parts[:-1]]


def imports(path: Path) -> Iterator[tuple[str, bool]]:
    """Yield what a file imports, by absolute name, and whether at the level of the module."""

    def visit(node: ast.AST, outer: bool) -> Iterator[tuple[str, bool]]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.Import):
                yield from ((alias.name, outer) for alias in child.names)
            elif isinstance(child, ast.ImportFrom):
                base = child.module or ""
                if child.level:
                    package = package_of(path)
                    package = package[: len(package) - child.level + 1]
                    base = ".".join([*package, *filter(None, [child.module])])
                yield base, outer
                yield from ((f"{base}.{alias.name}", outer) for alias in child.names)
            elif isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test):
                yield from visit(ast.Module(child.orelse, []), outer)
            else:
                inner = isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda))
                yield from visit(child, outer and not inner)

    yield from visit(ast.parse(path.read_text()), True)


def inside(name: str, *packages: str) -> bool:
    return any(name == package or name.startswith(f"{package}.") for package in packages)


def top(name: str) -> str:
    return name.partition(".")[0]


def relative(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def offending(paths: list[Path], allowed: Callable[[str, bool, Path], bool]) -> list[str]:
    """Return what files import, beyond what is allowed."""
    return [
        f"{relative(path)}: {name}"
        for path in paths
        for name, outer in imports(path)
        if not allowed(name, outer, path)
    ]


def test_derive_imports_sympy_and_jinja_alone():
    def allowed(name: str, outer: bool, path: Path) -> bool:
        if top(name) != "elastolink":
            return top(name) in STANDARD | {"sympy", "jinja2"}
        within = ("elastolink.derive", "elastolink._files")
        return name == "elastolink" or inside(name, *within)

    assert offending(sources("derive"), allowed) == []


def test_generated_imports_numpy_alone():
    assert offending(sources("generated"), lambda name, outer, path: name == "numpy") == []


@pytest.mark.parametrize("folder", ["templates", "derive"])
def test_packages_that_hold_a_docstring_and_no_code(folder):
    (statement,) = ast.parse((ROOT / folder / "__init__.py").read_text()).body
    assert isinstance(statement, ast.Expr)


def test_runtime_imports_numerics_and_the_rest_lazily():
    def allowed(name: str, outer: bool, path: Path) -> bool:
        if relative(path).startswith("runtime/_root/"):
            return top(name) in STANDARD
        if top(name) != "elastolink":
            return top(name) in STANDARD | NUMERIC | set(() if outer else LAZY.split())
        within = ["elastolink.runtime", "elastolink.generated", "elastolink._files"]
        within.append("elastolink.derive.spec" if outer else "elastolink.derive")
        passing = name in {"elastolink", "elastolink.derive", "elastolink.__version__"}
        return passing or inside(name, *within)

    assert offending(sources("runtime"), allowed) == []


def test_nothing_imports_a_folder_by_its_bare_name():
    """The root is on the path when tests run: a bare import would load a second copy."""
    bare = re.compile(rf"^\s*(?:import|from) +(?:{'|'.join(FOLDERS)})\b", re.MULTILINE)
    files = sources(*FOLDERS, "tests", "docs")
    assert [relative(path) for path in files if bare.search(path.read_text())] == []
    assert bare.search("    import runtime.hill\n")


def edges(folder: str) -> dict[tuple[str, str], str]:
    """Return pairs (importing package, imported package) below a folder with a file of each."""
    found: dict[tuple[str, str], str] = {}
    for path in sources(folder):
        own, *below = path.relative_to(ROOT / folder).parts
        for name, _ in imports(path) if below else ():
            target = name.removeprefix(f"{PACKAGES[folder]}.").partition(".")[0]
            if inside(name, PACKAGES[folder]) and (ROOT / folder / target).is_dir():
                found.setdefault((own, target), relative(path))
    return {pair: where for pair, where in found.items() if pair[0] != pair[1]}


def upward(pairs: dict[tuple[str, str], str]) -> dict[tuple[str, str], str]:
    """Return imports that do not point down the list of layers."""
    place = {name: k for k, name in enumerate(LAYERS.split())}
    return {pair: where for pair, where in pairs.items() if place[pair[0]] <= place[pair[1]]}


@pytest.mark.smoke
def test_every_room_has_its_place_and_imports_downwards_only():
    """Imports inside functions count; those for type checkers alone do not."""
    rooms = {p.parent.name for p in (ROOT / "runtime").glob("*/__init__.py")} - {"_root"}
    assert rooms == set(LAYERS.split())
    assert not upward({p: w for p, w in edges("runtime").items() if p[0] != "_root"})


@pytest.mark.smoke
def test_packages_of_derive_stand_in_no_circle():
    graph: dict[str, set[str]] = {}
    for importer, target in edges("derive"):
        graph.setdefault(importer, set()).add(target)
    assert graph
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as circle:
        pytest.fail(f"a circle: {circle.args[1]}")


def test_the_scan_of_imports_sees_what_it_has_to(tmp_path, monkeypatch):
    """The guard of the tests above: a forbidden import of every kind is found."""
    monkeypatch.setattr(sys.modules[__name__], "ROOT", tmp_path)
    path = tmp_path / "runtime" / "cli" / "new.py"
    path.parent.mkdir(parents=True)
    (tmp_path / "runtime" / "hill").mkdir()
    path.write_text(
        "if TYPE_CHECKING:\n    import jinja2\nelse:\n    import sympy\n"
        "from ...derive import pipeline\nfrom .. import hill\n"
        "try:\n    import scipy.linalg\nexcept ImportError:\n    pass\n"
        "def plot():\n    import matplotlib.pyplot\n    from . import options\n"
        "class A:\n    import numpy\n"
    )
    outer = "sympy scipy.linalg numpy elastolink.derive elastolink.derive.pipeline"
    outer += " elastolink.runtime elastolink.runtime.hill"
    inner = "matplotlib.pyplot elastolink.runtime.cli elastolink.runtime.cli.options"
    expected = dict.fromkeys(outer.split(), True) | dict.fromkeys(inner.split(), False)
    assert dict(imports(path)) == expected
    assert edges("runtime") == {("cli", "hill"): "runtime/cli/new.py"}
    assert not upward(edges("runtime")) and upward({("hill", "cli"): "runtime/hill/new.py"})


PARTS = ("runtime", "generated")
BLOCK = "import sys; sys.modules.update(dict.fromkeys({!r}));"
IMPORT_ALL = """
import importlib, pkgutil
package = importlib.import_module(sys.argv[1])
for found in pkgutil.walk_packages(package.__path__, sys.argv[1] + '.'):
    importlib.import_module(found.name)
"""


def test_runtime_loads_and_solves_with_the_symbolic_side_blocked():
    code = BLOCK.format(["sympy", "jinja2", "mpmath"]) + IMPORT_ALL.replace("sys.argv[1]", "ROOM")
    code = "".join(code.replace("ROOM", repr(f"elastolink.{room}")) for room in PARTS) + (
        "import numpy as np, elastolink as el\n"
        "scene = el.load_scene('smith_1972_5152_sixteenth_inch')\n"
        "system = scene.system()\n"
        "motion = el.simulate(system, speed=35.0, revolutions=2)\n"
        "assert motion.passed and np.abs(motion.q).max() > 0\n"
        "chart = el.stability_chart(system, x=('speed', np.linspace(20.0, 90.0, 12)),\n"
        "    y=('follower_inertia', np.linspace(1e-3, 5e-3, 10)))\n"
        "assert not chart.stable.all() and chart.stable.any()\n"
        "assert el.FourBar(frame=5, crank=1, coupler=5, follower=2).motion(0.3).theta3 > 0\n"
        "from elastolink.runtime.cli import main\n"
        "assert main(['kinematics', 'smith_1972_12_6_12_12', '--json']) == 0\n"
        "assert main(['stability', 'mathieu', '--json']) == 0\n"
        "f = el.PeriodicFunction(a=[0.0, 1.0])\n"
        "print(float(el.hill_boundaries(f, mu=0.1).lower[0]))\n"
    )
    said = python(code)
    assert "theta3" in said
    # b1(q = 0.2) / 4 by its series 1 - q - q^2/8 + q^3/64 - q^4/1536 - 11 q^5/36864, good to 1e-8.
    assert float(said.splitlines()[-1]) == pytest.approx(0.19878097, abs=2e-8)


def test_derive_loads_and_derives_with_the_numeric_side_blocked():
    blocked = ["scipy", "matplotlib", "pint", "tqdm", "elastolink.runtime", "elastolink.generated"]
    python(BLOCK.format(blocked) + IMPORT_ALL, "elastolink.derive")
    code = BLOCK.format(["numpy", *blocked]) + (
        "from elastolink.derive.jobs import jobs_of\n"
        "(job,) = jobs_of(['four_bar_coupler_reduced'], [], [], None)\n"
        "print(job.text())"
    )
    assert "def angle_functions(" in python(code)
