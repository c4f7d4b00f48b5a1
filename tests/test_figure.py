"""Figures: equal data give equal bytes in all formats, and the data drawn lie beside them."""

import re
import warnings
import zlib
from io import BytesIO

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from fontTools.ttLib import TTFont

from smallsat.drawing.figure import FORMATS, save_figure
from smallsat.drawing.style import SETTING, apply_style
from smallsat.results import read_table


def draw(stem, scale=1.0):
    apply_style()
    time = np.linspace(0.0, 3.0, 50)
    data = pd.DataFrame({"time": time, "radius": 1.0 + scale * time**2})
    figure, axes = plt.subplots()
    axes.plot(data["time"], data["radius"], label=r"$r(t)$")
    # Clipping and markers give SVG ids, which are random unless salted.
    axes.scatter(time[::10], data["radius"][::10])
    axes.legend()
    save_figure(figure, stem, data)
    plt.close(figure)
    return data


@pytest.mark.parametrize("suffix", FORMATS)
def test_equal_data_give_equal_bytes_and_other_data_do_not(tmp_path, suffix):
    draw(tmp_path / "one")
    draw(tmp_path / "two")
    draw(tmp_path / "other", scale=1.01)
    one = (tmp_path / f"one.{suffix}").read_bytes()
    assert one == (tmp_path / f"two.{suffix}").read_bytes()
    assert one != (tmp_path / f"other.{suffix}").read_bytes()


def test_the_data_drawn_lie_beside_the_figure(tmp_path):
    data = draw(tmp_path / "new/folder/fig-01")
    pd.testing.assert_frame_equal(read_table(tmp_path / "new/folder/fig-01.csv"), data, rtol=1e-8)


def test_fonts_travel_with_the_file(tmp_path):
    draw(tmp_path / "one")
    assert "<text" not in (tmp_path / "one.svg").read_text()
    assert b"/FontFile2" in (tmp_path / "one.pdf").read_bytes()


def test_an_embedded_font_has_no_tables_for_setting_text(tmp_path):
    """Its letters stand in the PDF already; to cut these tables takes longer than to draw."""
    draw(tmp_path / "one")
    streams = re.findall(
        rb"stream\r?\n(.*?)\r?\nendstream", (tmp_path / "one.pdf").read_bytes(), re.S
    )
    data = [zlib.decompress(stream) for stream in streams if stream[:1] == b"\x78"]
    fonts = [TTFont(BytesIO(one)) for one in data if one.startswith(b"\x00\x01\x00\x00")]
    assert fonts
    for font in fonts:
        assert "glyf" in font
        assert not {*SETTING} & {*font.keys()}


def test_places_do_not_hang_on_the_solver(tmp_path):
    """Axes stand at nine digits, before the next layout and after it."""
    figure, _ = plt.subplots(2, 2, layout="constrained")
    for _ in range(2):
        save_figure(figure, tmp_path / "figure", pd.DataFrame({"x": [1.0]}))
        for axes in figure.axes:
            place = axes.get_position(original=True).extents
            assert (place == place.round(9)).all()
            assert axes.get_in_layout()
    plt.close(figure)


def test_a_figure_without_a_layout_keeps_its_places_and_warns_of_nothing(tmp_path):
    """Saved in three formats under a style that lays figures out."""
    apply_style()
    figure = plt.figure(layout="none")
    axes = figure.add_axes((0.1, 0.2, 0.3, 0.4))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        save_figure(figure, tmp_path / "figure", pd.DataFrame({"x": [1.0]}))
    np.testing.assert_allclose(axes.get_position().bounds, (0.1, 0.2, 0.3, 0.4), rtol=1e-12)
    plt.close(figure)
