"""The LaTeX document: complete, balanced, the same on every run, with the model's own symbols."""

import re
from pathlib import Path

import pytest
from elastolink.derive.jobs import jobs_of
from elastolink.derive.latex import latex_document

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "slider_crank_rod.py"


def document(*names, model=None):
    return latex_document([(job.spec, job.model()) for job in jobs_of(names, [], [], model)])


def assert_well_formed(text):
    bare = re.sub(r"\\[\\{}_^~&%$#]", "", text)
    depth = 0
    for sign in bare:
        depth += {"{": 1, "}": -1}.get(sign, 0)
        assert depth >= 0
    assert depth == 0
    open_environments = []
    for kind, name in re.findall(r"\\(begin|end)\{([\w*]+)\}", text):
        if kind == "begin":
            open_environments.append(name)
        else:
            assert open_environments.pop() == name
    assert not open_environments
    assert text.count(r"\left") - text.count(r"\leftarrow") == text.count(r"\right")
    outside = re.sub(r"\\begin\{(align|gather)\*\}.*?\\end\{\1\*\}", "", text, flags=re.S)
    bare = re.sub(r"\\[\\{}_^~&%$#]", "", outside)
    assert bare.count("$") % 2 == 0
    words = re.sub(r"\$.*?\$", "", bare)
    assert not re.search(r"[_^&#]", words.partition(r"\maketitle")[2])
    assert all(ord(sign) < 128 for sign in text)


@pytest.mark.slow
def test_every_packaged_model_is_a_section_of_a_well_formed_document():
    # Of a model with several specs one, the last.
    names = list({id(job.model()): job.name for job in jobs_of([], [], [], None)}.values())
    everything = document(*names)
    assert_well_formed(everything)
    assert everything.startswith("\\documentclass")
    assert everything.endswith("\\end{document}\n")
    assert everything.count("\\section{") == len(names)
    for name in names:
        assert name.replace("_", r"\_") in everything


def test_a_continuum_shows_each_stage_with_its_symbols():
    example = document(model=str(EXAMPLE))
    assert_well_formed(example)
    stages = ["Lagrangian per length", "Field equations", "Natural conditions", "Projected arrays"]
    places = [example.index(f"\\subsection*{{{stage}") for stage in stages]
    assert places == sorted(places)
    for symbol in (
        r"{y}_{xxxx}",
        r"\ddot{\theta_{2}}",
        r"\mathrm{bending\_stiffness}",
        r"M_{mm} ={} &1",
        r"B_{mn}",
        r"f_{m}",
        r"s_{\mathrm{bend}}",
        r"variation of ${y}_{x}$",
    ):
        assert symbol in example


def test_constraints_and_supports_are_shown():
    text = document("slider_crank_multibody", "quick_return_rod_moving_basis")
    assert_well_formed(text)
    for part in (
        r"\Phi_q^T \lambda + Q,\quad \Phi = 0",
        r"\Phi_q ={} &",
        r"\subsection*{Jump conditions}",
        r"= 0$ at $x = 0$",
        r"Beale \& Scott",
    ):
        assert part in text
