"""Figures in one look."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from boresight.plots import COLOURS, panels, save


def drawn():
    figure, axes = panels(1, 2)
    axes[0, 0].plot([0, 1], [1, 2])
    axes[0, 1].semilogy([1, 10], [1, 100])
    return figure


def test_a_figure_is_written_as_png_and_svg(tmp_path):
    png, svg = save(drawn(), tmp_path / "figure")
    assert png.read_bytes().startswith(b"\x89PNG")
    assert ElementTree.parse(svg).getroot().tag.endswith("svg")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["figure.png", "figure.svg"]


def test_the_same_figure_gives_the_same_bytes(tmp_path):
    first, second = (save(drawn(), tmp_path / name) for name in ("one", "two"))
    assert all(a.read_bytes() == b.read_bytes() for a, b in zip(first, second, strict=True))


def test_lines_take_the_house_colours():
    _, axes = panels()
    lines = [axes[0, 0].plot(np.arange(3))[0].get_color() for _ in COLOURS]
    assert tuple(lines) == COLOURS


@pytest.mark.parametrize("name", [r"\frac", r"$\frac$", r"a$\frac$b", r"$\foo$.yaml", "$5 plate$", "a_b^c", r"\$x$"])
def test_names_are_never_read_as_formulas(name, tmp_path):
    figure, axes = panels()
    axes[0, 0].plot([1, 2], [1, 2], label=name)
    axes[0, 0].set_title(name, loc="left")
    axes[0, 0].set_xlabel(name)
    axes[0, 0].set_xticks([1, 2], [name, "other"])
    axes[0, 0].legend()
    _, svg = save(figure, tmp_path / "figure")
    texts = [
        "".join(text.itertext()) for text in ElementTree.parse(svg).getroot().iter("{http://www.w3.org/2000/svg}text")
    ]
    assert texts.count(name) == 4


def test_logarithmic_axes_have_plain_numbers(tmp_path):
    figure, axes = panels()
    axes[0, 0].loglog([1e-3, 1e2], [2.0, 8.0])
    _, svg = save(figure, tmp_path / "figure")
    texts = [
        "".join(text.itertext()) for text in ElementTree.parse(svg).getroot().iter("{http://www.w3.org/2000/svg}text")
    ]
    assert {"0.001", "0.1", "10"} <= set(texts)
    assert not any("$" in text for text in texts)
