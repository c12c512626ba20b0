"""What the site is made of beside pages that are written by hand.

The interface by subject from the public names, the list of the documents' figures, formulas as
MathML, and links where a page names another page or a public name.
"""

import inspect
import re
import shutil
from collections.abc import Iterator
from functools import cache
from html import unescape
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from xml.etree.ElementTree import Element, tostring

import elastolink
from docutils import nodes
from elastolink.runtime.gallery import figures
from elastolink.runtime.gallery.records import KINDS, Quoted
from latex2mathml.converter import convert_to_element
from pygments.lexers.special import TextLexer
from sphinx.addnodes import pending_xref

HERE = Path(__file__).parent
MADE = HERE / "build"

# Title, what it is about, and the modules of `elastolink.runtime` whose public names belong there.
SUBJECTS = {
    "kinematics": (
        "Kinematics",
        "Rigid linkages: motion in closed form, classes, coupler curves, clearance, tolerances of"
        " lengths.",
        ("linkages",),
    ),
    "rigid_machines": (
        "Rigid machines",
        "Masses, loads and springs, pin forces, driving torque, run-up, flywheels, balancing.",
        ("rigid",),
    ),
    "beams": (
        "Beams",
        "Linkages and frames whose members are beams, and what these have to bear: forces,"
        " stresses, reactions. The guide is :doc:`/beams`.",
        ("beams", "recovery"),
    ),
    "systems": (
        "Periodic systems",
        "The families of equations, how they are assembled, and their motion: transition and"
        " monodromy matrices, multipliers, steady states, constrained motion. Shapes and units:"
        " :doc:`/api`.",
        ("core.families", "systems", "periodic", "constrained"),
    ),
    "hill": (
        "Hill's equation",
        "Boundaries exact, certified and by perturbation; Mathieu's and Meissner's equations. Which"
        " to use when: :doc:`/hill`.",
        ("core.periodic_function", "hill"),
    ),
    "stability": (
        "Stability",
        "Charts over two parameters, the ends of unstable regions over the speed, combination"
        " resonances.",
        ("stability",),
    ),
    "frequencies": (
        "Frequencies",
        "Natural frequencies over the cycle, dynamic stiffness, Campbell's diagram, critical"
        " speeds, resonance curves.",
        ("frequencies",),
    ),
    "nonlinear": (
        "Nonlinear motion",
        "Beyond the linear range: response curves with their special points, coexisting motions,"
        " slow sweeps, basins. The guide is :doc:`/nonlinear`.",
        ("nonlinear",),
    ),
    "design": (
        "Design",
        "Quiet speeds, running speed and run-through; diagnosis, sensitivities, changes that"
        " stabilise, proofs of stability, bands of tolerances, fits to measured points, reports.",
        ("design", "report"),
    ),
    "scenes_and_results": (
        "Scenes and results",
        "Scenes read, changed and explained; results saved and loaded; errors and warnings. Every"
        " result is a :class:`elastolink.runtime.core.results.Result` with its methods.",
        ("scenes", "core.results", "core.errors", "cli.explanation"),
    ),
    "sweeps": (
        "Sweeps",
        "Any function over many points: processes, threads, stores that resume.",
        ("sweeps",),
    ),
    "figures": (
        "The documents' figures",
        "Records of the figures, and what draws and checks them: :doc:`/build/figures`.",
        ("gallery",),
    ),
}
# Of rooms that have no list of public names: what users meet.
BASES = {"core.results": ("Result", "Check"), "core.errors": ("BadInput",)}
# Characters from which a cell of a table is given a width of its own.
LONG = 60


def documented(value: object) -> bool:
    """Tell whether a public name is a class or a function: constants have no page."""
    return inspect.isclass(value) or inspect.isroutine(value)


def names_of(room: str) -> tuple[list[str], list[str]]:
    """Return the names of a room that `import elastolink` offers, and the others with theirs."""
    here = f"elastolink.runtime.{room}"
    first = [name for name, where in elastolink._PUBLIC.items() if where == room]
    listed = BASES.get(room, getattr(import_module(here), "__all__", ()))
    others = [name for name in listed if elastolink._PUBLIC.get(name) != room]
    kept = [name for name in others if documented(getattr(import_module(here), name))]
    return [f"elastolink.{name}" for name in first], [f"{here}.{name}" for name in kept]


def interface() -> Iterator[tuple[str, str]]:
    """Yield the file and text of each page of the interface."""
    held = {room for *_, rooms in SUBJECTS.values() for room in rooms}
    missing = set(elastolink._PUBLIC.values()) - held
    if missing:
        raise ValueError(f"no subject of the interface has the rooms {sorted(missing)}")
    for subject, (title, about, rooms) in SUBJECTS.items():
        found = [names_of(room) for room in rooms]
        tables = [
            ("With ``import elastolink as el``", [name for own, _ in found for name in own]),
            ("Further names", [name for _, others in found for name in others]),
        ]
        yield f"api/{subject}.rst", _subject(title, about, tables)
    authoring = import_module("elastolink.derive.authoring")
    names = [f"elastolink.derive.authoring.{name}" for name in authoring.__all__]
    about = "What model files are written with: a mechanism of your own, :doc:`/own_model`."
    yield "api/models.rst", _subject("Models of your own", about, [("Names", names)])
    listed = [(subject, said) for subject, (_, said, _) in SUBJECTS.items()] + [("models", about)]
    pages = "\n".join(f"   {subject}" for subject, _ in listed)
    words = "\n".join(f":doc:`{subject}`\n   {said}\n" for subject, said in listed)
    yield (
        "api/index.rst",
        "Interface by subject\n====================\n\n"
        "All public names, from their docstrings. Names of the first table of a page are those of"
        " ``import elastolink as el``; the others stand in the packages that they are listed"
        f" under.\n\n{words}\n.. toctree::\n   :hidden:\n\n{pages}\n",
    )


def _subject(title: str, about: str, tables: list[tuple[str, list[str]]]) -> str:
    parts = [f"{title}\n{'=' * len(title)}\n\n{about}\n"]
    for heading, names in tables:
        if names:
            lines = "\n".join(f"   {name}" for name in names)
            parts.append(
                f"{heading}\n{'-' * len(heading)}\n\n"
                f".. autosummary::\n   :toctree: names\n\n{lines}\n"
            )
    return "\n".join(parts)


@cache
def full_names() -> dict[str, str]:
    """Return under which name each public name is documented."""
    found = (names_of(room) for *_, rooms in SUBJECTS.values() for room in rooms)
    return {name.rpartition(".")[2]: name for pair in found for names in pair for name in names}


def figures_page() -> str:
    """Return the page of all figures of the documents, with the numbers that each is held to."""
    entries = figures()
    lines = [
        "# The documents' figures",
        "",
        f"Of three documents {len(entries)} figures and tables are redrawn from built-in scenes."
        " Each number that a document quotes of them is compared with the computed one:",
        "`elastolink reproduce smith --figure 84 --out gallery` draws a figure and prints the"
        " comparison, `elastolink reproduce --out gallery` all of them in two minutes.",
        "",
        "- **agrees**: the computed number lies within the tolerance of the expected one, or on the"
        " side of it that the words say;",
        "- **differs**: it is known not to, for the reason given.",
        "",
        "The tests compute every number anew and hold these verdicts.",
    ]
    for document in dict.fromkeys(entry.document for entry in entries):
        own = [entry for entry in entries if entry.document == document]
        rows = [row for entry in own for row in entry.quoted]
        known = sum(bool(row.differs) for row in rows)
        lines += [
            "",
            f"## {document.capitalize()}",
            "",
            f"{len(own)} figures and tables, {len(rows)} numbers: {len(rows) - known} agree,"
            f" {known} are known to differ.",
            "",
            "| figure | number | expected | tolerance | verdict |",
            "| --- | --- | --- | --- | --- |",
        ]
        for entry in own:
            lines.append(f"| **{_cell(entry.label)}** | **{_cell(entry.title)}** | | | |")
            lines += [_row(row) for row in entry.quoted]
    return "\n".join(lines) + "\n"


def _row(row: Quoted) -> str:
    sign = {"=": "", "<": "below ", ">": "above "}[row.relation]
    expected = f"{sign}{row.expected:.6g} {row.unit}".strip()
    verdict = f"differs: {row.differs}" if row.differs else "agrees"
    cells = (row.number, f"{expected} ({KINDS[row.kind][1]})", f"{row.tolerance:.3g}", verdict)
    return "| | " + " | ".join(_cell(cell) for cell in cells) + " |"


def _cell(text: str) -> str:
    """Return a text as the cell of a table in Markdown."""
    return re.sub(r"([\\`*_{}\[\]<>|$#~])", r"\\\1", " ".join(text.split()))


def make(*_: object) -> None:
    """Write all pages that are made, before Sphinx looks for pages."""
    shutil.rmtree(MADE / "api", ignore_errors=True)  # pages of names that are no more
    (MADE / "api").mkdir(parents=True)
    for file, text in (*interface(), ("figures.md", figures_page())):
        (MADE / file).write_text(text)


# Formulas as MathML, which browsers show without a program of their own.

FUNCTIONS = ("arg", "cos", "cosh", "cot", "exp", "ln", "log", "sin", "sinh", "tan", "tanh")


def mathml(formula: str, display: str = "inline") -> str:
    """Return a formula in LaTeX as MathML, with the spaces that TeX sets beside functions."""
    math = convert_to_element(formula, display=display)
    for element in math.iter():
        element.text = unescape(element.text or "")
        if element.tag == "mo" and element.text in ("|", "/"):
            element.attrib |= {"lspace": "0", "rspace": "0"}
    for row in [element for element in math.iter() if element.tag in ("math", "mrow", "mtd")]:
        parts = list(row)
        for left, right in reversed(list(pairwise(parts))):
            if (_is_function(left) and right.tag != "mo") or (
                _is_function(right) and left.tag != "mo"
            ):
                row.insert(list(row).index(right), Element("mspace", width="0.17em"))
    return tostring(math, encoding="unicode")


def _is_function(element: Element) -> bool:
    """Tell whether an element is a function's name, with or without a power."""
    base = element[0] if element.tag == "msup" else element
    return base.tag == "mi" and base.text in FUNCTIONS


def _inline(translator, node):
    translator.body.append(mathml(node.astext()))
    raise nodes.SkipNode


def _block(translator, node):
    translator.body.append(f'<div class="math">{mathml(node.astext(), "block")}</div>')
    raise nodes.SkipNode


def show_rooms(app, doctree):
    """Turn a chart of rooms, which code hosts draw, into a list of its rows."""
    for chart in list(doctree.findall(nodes.literal_block)):
        if chart.get("language") == "mermaid":
            rows = re.findall(r'subgraph \w+\["(.+?)"\]\s+(.+)', chart.astext())
            points = nodes.bullet_list()
            for title, rooms in rows:
                words = [nodes.strong(title, title), nodes.Text(f": {rooms.replace('-->', '→')}")]
                points += nodes.list_item("", nodes.paragraph("", "", *words))
            chart.replace_self(points)


def mark_long(app, doctree):
    """Mark cells of tables with whole sentences: their columns become wider."""
    for cell in doctree.findall(nodes.entry):
        if sum(len(text) for text in cell.findall(nodes.Text)) > LONG:
            cell["classes"].append("long")


# Links where a page names another page, a file beside it or a public name.


def link(app, doctree):
    """Make links of `docs/page.md` and `el.name(...)`, as pages write them."""
    here = app.env.docname
    for literal in list(doctree.findall(nodes.literal)):
        if isinstance(literal.parent, (nodes.reference, nodes.title, pending_xref)):
            continue
        text = literal.astext()
        page = re.fullmatch(r"docs/(\w+)\.md", text)
        name = re.match(r"el\.(\w+)", text)
        if page:
            target = {"refdomain": "std", "reftype": "doc", "reftarget": f"/{page[1]}"}
        elif name and name[1] in elastolink._PUBLIC:
            target = {"refdomain": "py", "reftype": "obj", "reftarget": f"elastolink.{name[1]}"}
        else:
            continue
        reference = pending_xref("", refdoc=here, refexplicit=True, refwarn=True, **target)
        literal.replace_self(reference)
        reference += literal


def skip(app, what, name, obj, skip, options):
    """Leave out what a class has of modules and classes: they are no words of its interface."""
    return True if what == "class" and (inspect.ismodule(obj) or inspect.isclass(obj)) else None


def resolve(app, env, node, contnode):
    """Find a public name that a docstring or a type names without its package."""
    full = full_names().get(node.get("reftarget", "").rpartition(".")[2])
    if node.get("refdomain") != "py" or full is None or full == node["reftarget"]:
        return None
    python = env.domains.python_domain
    args = (env, node["refdoc"], app.builder, "obj", full, node, contnode)
    return python.resolve_xref(*args)


def drop_absent(app, docname, source):
    """Leave out patterns of a list of pages (`name*`) that no page matches: pages to come."""
    if docname != "index":
        return
    source[0] = re.sub(
        r"^(\w+)\*\n",
        lambda line: line[0] if list(HERE.glob(f"{line[1]}*.md")) else "",
        source[0],
        flags=re.MULTILINE,
    )


def connect(app):
    """Connect all of this to Sphinx."""
    app.connect("config-inited", make)
    app.connect("source-read", drop_absent)
    app.connect("missing-reference", resolve)
    app.connect("autodoc-skip-member", skip)
    app.connect("doctree-read", link)
    app.connect("doctree-read", mark_long)
    app.connect("doctree-read", show_rooms)
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    for language in ("csv", "mermaid"):
        app.add_lexer(language, TextLexer)
