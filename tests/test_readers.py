"""The reader of plain columns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from movingfrf.roughness.readers.columns import read_columns

STATIONS, HEIGHTS = np.array([0.0, 0.5, 1.25, 2.0, 3.0]), np.array([583.1, 583.2, 583.15, 583.0, 583.05])


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", "   "])
@pytest.mark.parametrize("header", ["", "station{0}elevation\n", "# a comment\n\nx [m]{0}z [m]\n"])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_columns_in_every_dress(tmp_path, separator, header, newline):
    header = header.format(separator)
    if separator.isspace() and separator != "\t" and "[m]" in header:
        header = f"x{separator}z\n"
    text = header + "\n".join(f"{x}{separator}{z}" for x, z in zip(STATIONS, HEIGHTS, strict=True)) + "\n"
    file = tmp_path / "road.txt"
    file.write_bytes(text.replace("\n", newline).encode("utf-8-sig"))
    profile, understood = read_columns(file)
    assert np.array_equal(profile.distance, STATIONS)
    assert np.array_equal(profile.elevation, HEIGHTS)
    assert "5 stations from 0 m to 3 m" in understood
    assert ("no header" in understood) == (not header)


def test_several_paths(tmp_path):
    file = tmp_path / "road.csv"
    file.write_text("\n".join(f"{x},{x},{-x}" for x in range(5)))
    profile, understood = read_columns(file)
    assert profile.paths == 2
    assert "2 path(s)" in understood
    assert "every 1 m" in understood


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("x,z\n", "at least one elevation"),
        ("1\n2\n3\n4\n", "at least one elevation"),
        ("0,1\n1,2\n2,x\n3,4\n", "line 3: expected numbers separated by commas, got '2,x'"),
        ("0,1\n1,2\n2\n3,4\n", "line 3: expected 2 columns"),
        ("0,1\n1,2\n1,3\n2,4\n", "distance must increase, got 1 m followed by 1 m at index 2"),
        ("0,1\n1,2\n2,nan\n3,4\n", "elevation must be finite"),
        ("0,1\n1,2\n2,3\n", "at least 4 stations"),
        ("0,5.8o3\n1,2\n2,3\n3,4\n4,5\n", "line 1: expected numbers"),
    ],
)
def test_faulty_columns(tmp_path, text, message):
    file = tmp_path / "road.csv"
    file.write_text(text)
    with pytest.raises(ValueError, match=message):
        read_columns(file)


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(ValueError, match="No such file"):
        read_columns(tmp_path / "none.csv")
    (tmp_path / "binary").write_bytes(bytes(range(256)))
    with pytest.raises(ValueError, match="not a text file"):
        read_columns(tmp_path / "binary")


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.binary(max_size=200), st.integers(0, 60))
def test_nonsense_is_refused_and_never_a_defect(tmp_path_factory, junk, at):
    file = tmp_path_factory.getbasetemp() / "fuzz.csv"
    text = b"\n".join(f"{x},{z}".encode() for x, z in zip(STATIONS, HEIGHTS, strict=True))
    for content in (junk, text[:at] + junk[:3] + text[at:]):
        file.write_bytes(content)
        try:
            read_columns(file)
        except ValueError as error:
            assert str(error)  # noqa: PT017
