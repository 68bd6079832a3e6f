"""Files of curves as programs, people and instruments write them: each is the record that was made, or one sentence."""

import math

import numpy as np
import pytest

from comparisons.fitting.motion import phases, senses
from comparisons.fitting.reading import Sensitivity, read_records

STIFFNESS = 0.5


def cycle(points=120):
    """Height towards the solid in nm and load in nN: flat, a jump into contact, and one off later on the way back."""
    height = np.linspace(-150.0, 60.0, points)
    load = np.where(height < 0.0, 0.0, -8.0 + 0.4 * height)
    back = np.where(height < -40.0, 0.0, -8.0 + 0.4 * height)
    noise = 0.05 * np.cos(7.0 * np.arange(2 * points))
    return np.concatenate([height, height[::-1]]), np.concatenate([load, back[::-1]]) + noise


HEIGHT, LOAD = cycle()
HALF = len(LOAD) // 2
DEFLECTION = LOAD / STIFFNESS


def table(columns, rows, delimiter=",", comma=False):
    lines = [delimiter.join(columns)]
    for row in rows:
        cells = [cell if isinstance(cell, str) else f"{cell:.10g}" for cell in row]
        lines.append(delimiter.join(cell.replace(".", ",") if comma else cell for cell in cells))
    return "\n".join(lines) + "\n"


def read(tmp_path, text, name="a.csv", **options):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    (record,) = read_records(path, **{"stiffness": STIFFNESS} | options)
    return record


def assert_is_the_cycle(record, points=HALF, load=LOAD):
    """Approach towards the solid, and retreat, in nN and nm."""
    assert record.approach.tolist() == [True] * points + [False] * points
    assert record.load == pytest.approx(1e-9 * load, abs=1e-14)
    rise = np.diff(record.position)
    assert (rise[: points - 1] > 0.0).all()
    assert (rise[points:] < 0.0).all()


@pytest.mark.parametrize(
    ("columns", "values", "options"),
    [
        (["height [nm]", "deflection [nm]"], (HEIGHT, DEFLECTION), {}),
        (["Height (nm)", "Deflection (nm)"], (-HEIGHT, DEFLECTION), {}),
        (["height [nm]", "deflection [nm]"], (HEIGHT, -DEFLECTION), {}),
        (["height [nm]", "deflection [nm]"], (-HEIGHT, -DEFLECTION), {}),
        (["Z / um", "Vertical Deflection {mV}"], (1e-3 * HEIGHT, 10.0 * DEFLECTION), {"sensitivity": 1e-7}),
        (["z [nm]", "deflection [nA]"], (HEIGHT, DEFLECTION), {"sensitivity": Sensitivity(1.0, "A")}),
        (["z [nm]", "deflection [count]"], (HEIGHT, DEFLECTION), {"sensitivity": Sensitivity(1e-9, "count")}),
        (["Indentation (nm)", "Force (nN)"], (HEIGHT - DEFLECTION, LOAD), {}),
        (["Tip Sample Separation (nm)", "Force (nN)"], (DEFLECTION - HEIGHT, LOAD), {}),
        (["height [nm]", "vDeflection [N]"], (HEIGHT, 1e-9 * LOAD), {}),
        (["height [nm]", "height (measured) [nm]", "load [nN]"], (HEIGHT, 0.0 * HEIGHT, LOAD), {}),
    ],
)
def test_names_units_and_senses_of_columns(tmp_path, columns, values, options):
    assert_is_the_cycle(read(tmp_path, table(columns, zip(*values, strict=True)), **options))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_encodings_of_instruments(tmp_path, encoding):
    text = table(["height [µm]", "load [nN]"], zip(1e-3 * HEIGHT, LOAD, strict=True))
    assert_is_the_cycle(read(tmp_path, text.encode(encoding)))


@pytest.mark.parametrize(("delimiter", "comma"), [(";", False), (";", True), ("\t", False), ("\t", True)])
def test_separators_and_decimal_commas(tmp_path, delimiter, comma):
    text = table(["height [nm]", "load [nN]"], zip(HEIGHT, LOAD, strict=True), delimiter, comma)
    assert_is_the_cycle(read(tmp_path, text))


def test_quoted_decimal_commas_are_unambiguous(tmp_path):
    rows = [(f'"{x:.3f}"'.replace(".", ","), f'"{y:.6f}"'.replace(".", ",")) for x, y in zip(HEIGHT, LOAD, strict=True)]
    assert_is_the_cycle(read(tmp_path, table(["height [nm]", "load [nN]"], rows)))


def test_further_columns_are_named_and_not_read(tmp_path):
    rows = zip(np.arange(2.0 * HALF), HEIGHT, LOAD, strict=True)
    record = read(tmp_path, table(["Time (s)", "height [nm]", "load [nN]"], rows))
    assert_is_the_cycle(record)
    assert any("time (s)" in remark for remark in record.remarks)


def test_an_empty_cell_after_the_last_column_is_nothing(tmp_path):
    text = table(["height [nm]", "load [nN]"], zip(HEIGHT, LOAD, [""] * len(LOAD), strict=True))
    assert_is_the_cycle(read(tmp_path, text))


@pytest.mark.parametrize("words", [("approach", "retreat"), ("Extend", "Retract"), ("trace", "retrace")])
@pytest.mark.parametrize("backwards", [False, True])
def test_words_of_the_motion(tmp_path, words, backwards):
    """A retreat may be listed first, and each branch against its motion."""
    branches = [words[0]] * HALF + [words[1]] * HALF
    rows = list(zip(branches, HEIGHT, LOAD, strict=True))
    if backwards:
        rows = rows[::-1]
    assert_is_the_cycle(read(tmp_path, table(["segment", "height [nm]", "load [nN]"], rows)))


@pytest.mark.parametrize("named", [False, True])
def test_rests_are_left_out_and_counted(tmp_path, named):
    """Wait, approach, dwell with a load that relaxes, retreat."""
    relaxing = LOAD[HALF - 1] - 0.2 * np.linspace(0.0, 1.0, 40)
    height = np.concatenate([np.full(30, HEIGHT[0]), HEIGHT[:HALF], np.full(40, HEIGHT[HALF]), HEIGHT[HALF:]])
    load = np.concatenate([np.full(30, LOAD[0]), LOAD[:HALF], relaxing, LOAD[HALF:]])
    words = ["pause"] * 30 + ["extend"] * HALF + ["pause"] * 40 + ["retract"] * HALF
    if named:
        record = read(tmp_path, table(["segment", "height [nm]", "load [nN]"], zip(words, height, load, strict=True)))
        assert_is_the_cycle(record)
        assert any("70 points" in remark for remark in record.remarks)
        return
    record = read(tmp_path, table(["height [nm]", "load [nN]"], zip(height, load, strict=True)))
    approach, retreat = int(record.approach.sum()), int((~record.approach).sum())
    assert HALF - 5 < approach <= HALF
    assert HALF - 5 < retreat <= HALF
    assert sum("rests" in remark for remark in record.remarks) == 2
    assert record.load.max() == pytest.approx(1e-9 * LOAD.max(), rel=0.1)


def test_a_text_with_segments_in_comments(tmp_path):
    lines = ["# TEXT EXPORT", "# springConstant: 0.5", "# sensitivity: 5E-8", "# columns: height vDeflection time"]
    lines += ["# units: m N s"]
    for motion, part in (("extend", slice(None, HALF)), ("pause", None), ("retract", slice(HALF, None))):
        lines += ["# segment: " + motion, ""]
        if part is None:
            lines += [f"{-1e-9 * HEIGHT[HALF]:.6e} {1e-9 * LOAD[HALF]:.6e} 0"] * 9
        else:
            lines += [f"{-1e-9 * x:.9e} {1e-9 * y:.9e} 1" for x, y in zip(HEIGHT[part], LOAD[part], strict=True)]
    record = read(tmp_path, "\n".join(lines) + "\n", "export.txt", stiffness=None)
    assert_is_the_cycle(record)
    assert record.stiffness == 0.5
    assert any("9 points" in remark for remark in record.remarks)


def test_a_text_with_both_branches_side_by_side(tmp_path):
    """The retreat of the other branch is shorter, and listed from the far end as well."""
    names = ["Calc_Ramp_Ex_nm", "Calc_Ramp_Rt_nm", "Defl_pN_Ex", "Defl_pN_Rt", "Defl_V_Ex", "Defl_V_Rt"]
    rows = []
    for i in range(HALF):
        j = HALF + i
        rows.append((HEIGHT[i], HEIGHT[j], 1e3 * LOAD[i], 1e3 * LOAD[j], 0.0, 0.0))
    text = '"\\*File list"\n"\\Version: 0x1"\n' + table(names, rows, "\t")
    assert_is_the_cycle(read(tmp_path, text, "nanoscope.txt"))


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        (table(["height [nm]", "load [nN]", "load [uN]"], [(0.0, 0.0, 0.0)]), {}, "load stands twice"),
        (table(["height", "load [nN]"], [(0.0, 0.0)]), {}, "no unit"),
        (table(["height [nm]", "deflection [V]"], [(0.0, 0.0)]), {}, "--sensitivity"),
        (table(["height [nm]", "deflection [nA]"], [(0.0, 0.0)]), {"sensitivity": 1e-7}, "signal in V"),
        (table(["height [nm]", "deflection [nm]"], [(0.0, 0.0)]), {"stiffness": None}, "--stiffness"),
        (table(["height [nm]", "load [nN]"], [(0.0, 0.0)]), {"stiffness": None}, "--stiffness"),
        (table(["load [nN]"], [(0.0,)]), {}, "displacement"),
        (table(["a", "b"], [(0.0, 0.0)]), {}, "displacement"),
        (table(["height [nm]", "load [nN]"], [("0,5", "1.5")], ";"), {}, "comma"),
        ("displacement [nm],load [nN]\n-11,90,1,09\n", {}, "semicolons"),
        (table(["branch", "height [nm]", "load [nN]"], [("sideways", 0.0, 0.0)]), {}, "sideways"),
        ("", {}, "empty"),
    ],
)
def test_what_cannot_be_read_is_one_sentence(tmp_path, text, options, words):
    with pytest.raises(ValueError, match=words) as refusal:
        read(tmp_path, text, **options)
    assert "\n" not in str(refusal.value)
    assert "a.csv" in str(refusal.value)


def test_a_second_approach_is_refused(tmp_path):
    rows = zip(np.tile(HEIGHT, 2), np.tile(LOAD, 2), strict=True)
    with pytest.raises(ValueError, match="more than one approach"):
        read(tmp_path, table(["height [nm]", "load [nN]"], rows))


def test_a_branch_alone_is_that_branch(tmp_path):
    for part, is_approach in ((slice(None, HALF), True), (slice(HALF, None), False)):
        rows = zip(HEIGHT[part], LOAD[part], strict=True)
        record = read(tmp_path, table(["height [nm]", "load [nN]"], rows))
        assert np.mean(record.approach == is_approach) > 0.98


def test_a_flat_record_has_no_sense():
    noise = np.cos(7.0 * np.arange(100.0))
    assert senses(np.arange(100.0), noise) == (None, None)
    assert senses(np.zeros(100), noise) == (None, None)


def test_a_slow_begin_is_no_rest():
    """A ramp of cosine shape is slow at its ends, and rests nowhere."""
    position = -np.cos(np.linspace(0.0, 2.0 * math.pi, 400))
    moving = phases(position)
    assert not moving.rests
    assert moving.approach.sum() + moving.retreat.sum() == 400
