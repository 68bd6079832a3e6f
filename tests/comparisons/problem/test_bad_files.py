"""Every bad problem file gets one sentence with file, line, value and remedy, and exit status 2."""

import math

import numpy as np
import pytest

from comparisons.cli.main import main
from comparisons.problem.reading import load_problem

GOOD = """\
[solid]
kind = "offset-power-law"
E0 = "2 GPa"
c0 = "1 um"
k = 0.4
z_s = "10 nm"
nu = 0.3

[punch]
kind = "sphere"
R = "2.5 um"

[law]
kind = "lennard-jones-9-3"
work_of_adhesion = "50 mJ/m^2"
z0 = "0.4 nm"
"""

E0, R, Z0 = 'E0 = "2 GPa"', 'R = "2.5 um"', 'z0 = "0.4 nm"'
SOLID = GOOD[: GOOD.index("[punch]")]
PUNCH = GOOD[GOOD.index("[punch]") : GOOD.index("[law]")]
LAW = GOOD[GOOD.index("[law]") :]
SOLID_TABLE = '[solid]\nkind = "table"\nfile = "modulus.csv"\nnu = 0.3\n\n'
PUNCH_TABLE = '[punch]\nkind = "table"\nfile = "profile.csv"\n\n'
LAW_TABLE = '[law]\nkind = "table"\nfile = "law.csv"\n'

#: Name, text that is replaced, its replacement, and parts of the sentence in their order.
BAD_TEXT = [
    ("text without unit", E0, 'E0 = "2"', ["line 3", '[solid] E0 = "2" has no unit', '"2 GPa"']),
    ("wrong dimension", E0, 'E0 = "2 nm"', ["line 3", "E0", "unit nm, which is not that of a modulus", '"2 GPa"']),
    ("unknown unit", E0, 'E0 = "2 GPascals"', ["line 3", "unknown unit 'GPascals'", '"2 GPa"']),
    ("unit that calculates", E0, 'E0 = "2 m**9**9**9"', ["line 3", "no product of units"]),
    ("deviation without unit", E0, 'E0 = "2 GPa +- 0.1"', ["line 3", "a standard deviation without a unit", '"2 GPa"']),
    ("deviation of a wrong unit", E0, 'E0 = "2 GPa +- 1 nm"', ["line 3", "unit nm, which is not that of a modulus"]),
    ("no deviation", E0, 'E0 = "2 GPa +- 0 %"', ["line 3", "a standard deviation that is not above 0"]),
    ("large deviation", E0, 'E0 = "2 GPa +- 3 GPa"', ["line 3", "reaches the end of its range; write a smaller one"]),
    ("interval without unit", E0, 'E0 = "[1, 2]"', ["line 3", "has no unit", '"2 GPa"']),
    ("interval the other way", E0, 'E0 = "[2, 1] GPa"', ["line 3", "first end is not below the second"]),
    ("interval beyond the range", "nu = 0.3", 'nu = "[0.4, 0.6]"', ["line 7", "must be at most 0.5"]),
    ("interval that reaches zero", E0, 'E0 = "[0, 2] GPa"', ["line 3", "must be above 0"]),
    (
        "uncertain exponent with a unit",
        "k = 0.4",
        'k = "0.4 +- 1 nm"',
        ["line 5", "no plain number with an uncertainty"],
    ),
    ("two deviations", E0, 'E0 = "2 +- 1 +- 1 GPa"', ["line 3", "is no value +- standard deviation and no [interval]"]),
    ("no number", E0, 'E0 = "GPa"', ["line 3", "no number with a unit", '"2 GPa"']),
    ("negative modulus", E0, 'E0 = "-2 GPa"', ["line 3", 'E0 = "-2 GPa" must be above 0', '"2 GPa"']),
    ("zero modulus", E0, "E0 = 0", ["line 3", "E0 = 0 must be above 0"]),
    ("true", E0, "E0 = true", ["line 3", "E0 = true is no number"]),
    ("list", E0, "E0 = [1.0, 2.0]", ["line 3", "E0 = [1.0, 2.0] is no number"]),
    ("not a number", E0, "E0 = nan", ["line 3", "E0 = nan is not a finite number"]),
    ("infinite", E0, "E0 = inf", ["line 3", "E0 = inf is not a finite number"]),
    ("too large", E0, 'E0 = "1e999 GPa"', ["line 3", "is not a finite number"]),
    ("a length beyond all sizes", R, 'R = "1e200 m"', ["line 11", 'R = "1e200 m"', "1e+20 m"]),
    ("a layer of no thickness", '"10 nm"', '"1e-200 nm"', ["line 6", 'z_s = "1e-200 nm"', "1e-20 to"]),
    ("huge integer", E0, f"E0 = 1{'0' * 400}", ["line 3", "is not a finite number"]),
    ("exponent with a unit", "k = 0.4", 'k = "0.4"', ["line 5", 'k = "0.4" is a text', "plain number from 0"]),
    ("exponent above 1", "k = 0.4", "k = 1.4", ["line 5", "k = 1.4 must be below 1"]),
    ("incompressible and more", "nu = 0.3", "nu = 0.6", ["line 7", "nu = 0.6 must be at most 0.5"]),
    ("unknown key", "z_s =", "zs =", ["line 6", 'unknown key "zs"', "did you mean z_s?"]),
    ("missing key", 'c0 = "1 um"\n', "", ["line 1", "[solid] c0 is missing", "E0, c0, k, z_s and nu"]),
    ("right angle", 'kind = "sphere"\nR = "2.5 um"', 'kind = "cone"\nhalf_angle = "90 deg"', ["line 11", "half_angle"]),
    ("degrees as radians", 'kind = "sphere"\nR = "2.5 um"', 'kind = "cone"\nhalf_angle = 70', ["line 11", "70", "deg"]),
    ("percent", 'kind = "sphere"\nR = "2.5 um"', 'kind = "cone"\nhalf_angle = "70 percent"', ["line 11", "an angle"]),
    ("unknown kind", '"sphere"', '"sphare"', ["line 10", 'kind = "sphare" is unknown', "did you mean sphere?"]),
    ("no kind", 'kind = "sphere"\n', "", ["line 9", "[punch] has no kind", "write one of sphere"]),
    ("kind of a wrong type", '"sphere"', "3", ["line 10", "kind = 3 is unknown"]),
    ("unknown section", "[law]", "[lawn]", ["line 13", "[lawn] is unknown", "did you mean law?"]),
    ("missing section", LAW, "", ["the section [law] is missing"]),
    ("section that is no table", GOOD, f"law = 3\n{SOLID}{PUNCH}", ["line 1", "[law] is 3 and no table"]),
    ("no TOML", R, "R = 2.5 um", ["line 11", '"R = 2.5 um" is not TOML', "text in quotes"]),
    ("twice", R, f"{R}\n{R}", ["line 12", "is not TOML"]),
    ("empty", GOOD, "", ["the section [solid] is missing"]),
    ("punch of another scale", R, 'R = "2.5e6 m"', ["line 11", "6.2e+15 times the range", "check the units"]),
    ("law of another scale", Z0, "z0 = 400.0", ["line 11", "6.3e-09 times the range", "check the units"]),
    ("modulus of another scale", E0, 'E0 = "2e-25 GPa"', ["Tabor number", "check the values and their units"]),
    ("attraction without end", LAW, LAW.replace("lennard-jones-9-3", "mie") + "m = 9\nn = 1\n", ["n = 1", "above 1"]),
    ("repulsion too weak", LAW, LAW.replace("lennard-jones-9-3", "mie") + "m = 3\nn = 6\n", ["line 13", "repulsion"]),
    (
        "one of two ratios",
        SOLID,
        '[solid]\nkind = "coating"\nE_coating = 1e9\nE_substrate = 1e10\nthickness = 1e-8\ntransition = 0\n'
        "nu_coating = 0.3\n\n",
        ["line 1", "nu_substrate is missing", "nu_coating and nu_substrate stand together"],
    ),
    (
        "all ratios",
        SOLID,
        '[solid]\nkind = "coating"\nE_coating = 1e9\nE_substrate = 1e10\nthickness = 1e-8\ntransition = 0\n'
        "nu = 0.2\nnu_coating = 0.3\n\n",
        ["line 1", "needs nu or else nu_coating and nu_substrate"],
    ),
    ("thousands of digits", E0, f"E0 = 1{'0' * 5000}", ["line 3", "has too many digits", "1e9"]),
    ("decimal comma", E0, 'E0 = "2,5 GPa"', ["line 3", "has a comma in place of a decimal point", '"2 GPa"']),
    ("a long unit", E0, f'E0 = "2 {"G" * 5000}Pa"', ["line 3", "has the unknown unit 'GGG", "...; it is a positive"]),
    ("a date", E0, "E0 = 2024-01-01", ["line 3", "E0 = 2024-01-01 is no number"]),
    ("list of sections", "[solid]", "[[solid]]", ["line 1", "is a list of sections", "[solid] in single brackets"]),
    (
        "a power of a length",
        PUNCH,
        '[punch]\nkind = "power-law"\nn = 3\nQ = "1 um"\n\n',
        ["line 12", "unit um, which is not that of m^(2)", '"1 um^(2)" or a plain number in m^(2)'],
    ),
    (
        "a name that is too long",
        PUNCH,
        f'[punch]\nkind = "table"\nfile = "{"a" * 5000}"\n\n',
        ["line 11", 'file = "aaa', "... is not in the folder"],
    ),
    ("a name with a NUL", PUNCH, PUNCH_TABLE.replace("profile", "a\\u0000b"), ["line 11", "is not in the folder"]),
]

#: Name, sections, file and content of a table, and parts of the sentence.
BAD_TABLES = [
    ("missing table", SOLID_TABLE, "other.csv", "", ["line 3", 'file = "modulus.csv" is not in the folder']),
    ("empty table", SOLID_TABLE, "modulus.csv", "\n", ["modulus.csv: the table is empty", "names z,E"]),
    ("no names", SOLID_TABLE, "modulus.csv", "0,1e9\n1e-8,2e9\n", ["line 1", "no name of a column"]),
    ("one row", SOLID_TABLE, "modulus.csv", "z,E\n0,1e9\n", ["the table has 1 row; it needs at least 2"]),
    (
        "not sorted",
        SOLID_TABLE,
        "modulus.csv",
        "z,E\n0,1\n2,1\n1,3\n",
        ["line 4", "z = 1 is not above", "sort the rows"],
    ),
    ("not a number", SOLID_TABLE, "modulus.csv", "z,E\n0,1\n1,nan\n", ["line 3", "E = nan is not a finite number"]),
    ("word", SOLID_TABLE, "modulus.csv", "z,E\n0,1\n1,soft\n", ["line 3", 'E = "soft" is no number']),
    ("negative", SOLID_TABLE, "modulus.csv", "z,E\n0,1\n1,-2\n", ["line 3", "E = -2 is outside (0, inf)"]),
    ("huge modulus", SOLID_TABLE, "modulus.csv", "z,E\n0,1\n1,1e300\n", ["line 3", "E = 1e300", "1e+20 Pa"]),
    ("small modulus", SOLID_TABLE, "modulus.csv", "z,E\n0,1\n1,1e-300\n", ["line 3", "E = 1e-300", "1e-20 to"]),
    ("huge depth", SOLID_TABLE, "modulus.csv", "z [nm],E\n0,1\n1e300,2\n", ["line 3", "z = 1e300", "1e+20 m"]),
    ("huge height", PUNCH_TABLE, "profile.csv", "r,height\n0,0\n1e-6,1e300\n", ["line 3", "height = 1e300"]),
    ("huge radius", PUNCH_TABLE, "profile.csv", "r,height\n0,0\n1e300,1\n", ["line 3", "r = 1e300"]),
    ("huge traction", LAW_TABLE, "law.csv", "gap,traction\n1e-10,1e300\n", ["line 2", "traction = 1e300"]),
    ("short row", SOLID_TABLE, "modulus.csv", "z,E\n0,1\n1\n", ["line 3", "1 values for 2 columns"]),
    ("unknown column", SOLID_TABLE, "modulus.csv", "z,Emod\n0,1\n", ["line 1", 'unknown column "Emod"', "columns are"]),
    ("missing column", SOLID_TABLE, "modulus.csv", "z\n0\n", ["line 1", "the column E is missing"]),
    ("wrong unit", SOLID_TABLE, "modulus.csv", "z [GPa],E\n0,1\n1,2\n", ["line 1", "the column z has the unit GPa"]),
    ("two ratios", SOLID_TABLE, "modulus.csv", "z,E,nu\n0,1,0.3\n1,2,0.3\n", ["line 1", "both have nu"]),
    (
        "short profile",
        PUNCH_TABLE,
        "profile.csv",
        "r [um],height [nm]\n0,0\n1,0.2\n",
        ["inside the contact", "further out"],
    ),
    ("no apex", PUNCH_TABLE, "profile.csv", "r,height\n1e-7,1e-8\n2e-7,4e-8\n", ["the apex (0, 0)", "subtract"]),
    ("hollow", PUNCH_TABLE, "profile.csv", "r,height\n0,0\n2e-7,-4e-8\n", ["not above the first one"]),
    ("a long cell", PUNCH_TABLE, "profile.csv", f"r,height\n0,{'1' * 200_000}\n", ["line 2", "is no row of CSV"]),
    ("short law", LAW_TABLE, "law.csv", "gap,traction\n0,1\n1,-1\n", ["has 2 rows; it needs at least 10"]),
    (
        "law without attraction",
        LAW_TABLE,
        "law.csv",
        "gap [nm],traction [MPa]\n" + "".join(f"{i},{10 / i}\n" for i in range(1, 12)),
        ["[law]", "traction", "correct the values"],
    ),
]


def refused(folder, capsys, *parts):
    """The one sentence of the command for the file of a folder; it has the parts in their order."""
    status = main(["solve", "--model", "fscm", "--quantity", "pull_off_force", "--problem", str(folder / "pad.toml")])
    captured = capsys.readouterr()
    assert status == 2
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    place = 0
    for part in parts:
        place = captured.err.find(part, place)
        assert place >= 0, f"{part!r} is not in {captured.err!r}"
    return captured.err


@pytest.mark.parametrize(("old", "new", "parts"), [row[1:] for row in BAD_TEXT], ids=[row[0] for row in BAD_TEXT])
def test_bad_text(old, new, parts, tmp_path, capsys):
    assert old in GOOD
    (tmp_path / "pad.toml").write_text(GOOD.replace(old, new))
    assert "pad.toml" in refused(tmp_path, capsys, *parts)


@pytest.mark.parametrize(
    ("section", "name", "text", "parts"), [r[1:] for r in BAD_TABLES], ids=[r[0] for r in BAD_TABLES]
)
def test_bad_tables(section, name, text, parts, tmp_path, capsys):
    replaced = next(part for part in (SOLID, PUNCH, LAW) if part.split("]")[0] == section.split("]")[0])
    (tmp_path / "pad.toml").write_text(GOOD.replace(replaced, section))
    (tmp_path / name).write_text(text)
    refused(tmp_path, capsys, *parts)


def test_a_file_that_is_missing(tmp_path, capsys):
    refused(tmp_path, capsys, "pad.toml: the problem file cannot be read (No such file or directory)")


def test_a_folder(tmp_path, capsys):
    (tmp_path / "pad.toml").mkdir()
    refused(tmp_path, capsys, "pad.toml: the problem file cannot be read")


@pytest.mark.parametrize(
    "name", ["../theirs.csv", "{folder}/theirs.csv", "link.csv", "tables/../../theirs.csv", "linked/a"]
)
def test_a_table_outside_the_folder_is_neither_read_nor_shown(name, tmp_path, capsys):
    folder = tmp_path / "mine"
    folder.mkdir()
    secret = "first line of theirs"
    for path in (tmp_path / "theirs.csv", tmp_path / "a"):
        path.write_text(f"{secret}\n1,2\n")
    (folder / "link.csv").symlink_to(tmp_path / "theirs.csv")
    (folder / "linked").symlink_to(tmp_path)
    name = name.format(folder=tmp_path)
    (folder / "pad.toml").write_text(GOOD.replace(SOLID, SOLID_TABLE.replace("modulus.csv", name)))
    error = refused(folder, capsys, "line 3", f'file = "{name}"'[:40], "is not in the folder")
    assert secret not in error


def test_a_table_in_a_folder_below_is_read(tmp_path):
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "a.csv").write_text("z,E\n0,1e9\n1e-8,2e9\n")
    (tmp_path / "tables" / "link.csv").symlink_to(tmp_path / "tables" / "a.csv")
    for name in ("tables/a.csv", "./tables/link.csv"):
        (tmp_path / "pad.toml").write_text(GOOD.replace(SOLID, SOLID_TABLE.replace("modulus.csv", name)))
        assert load_problem(tmp_path / "pad.toml").solid.columns["E"] == (1e9, 2e9)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("z_s", "z" * 3_000_000),
        ("[law]", f"[{'l' * 3_000_000}]"),
        ('"2 GPa"', f'"2 {"G" * 3_000_000}Pa"'),
        ('"sphere"', f'"{"s" * 3_000_000}"'),
    ],
    ids=["key", "section", "unit", "kind"],
)
def test_a_word_of_megabytes(old, new, tmp_path, capsys):
    (tmp_path / "pad.toml").write_text(GOOD.replace(old, new, 1))
    assert len(refused(tmp_path, capsys, "pad.toml", "3000")) < 500


def test_the_standard_input(capsys):
    assert main(["describe", "-"]) == 2
    assert capsys.readouterr().err == (
        "fscm-bench: -: the problem file is not read from the standard input; give the name of a file\n"
    )


def test_a_name_with_a_nul_or_that_is_too_long(capsys):
    for name, words in (("a\0b", "embedded null byte"), ("x" * 5000, "File name too long")):
        assert main(["describe", name]) == 2
        error = capsys.readouterr().err
        assert f"the problem file cannot be read ({words}); check the name" in error


@pytest.mark.parametrize("form", ["utf-8-sig", "CRLF", "CR"])
def test_marks_and_ends_of_lines_of_other_systems(form, tmp_path):
    text = GOOD.replace("um", "µm")
    (tmp_path / "plain.toml").write_text(text, encoding="utf-8")
    ends = {"CRLF": "\r\n", "CR": "\r"}
    content = text.replace("\n", ends.get(form, "\n")).encode("utf-8" if form in ends else form)
    (tmp_path / "pad.toml").write_bytes(content)
    assert load_problem(tmp_path / "pad.toml").solid == load_problem(tmp_path / "plain.toml").solid


def test_a_file_that_is_not_utf_8(tmp_path, capsys):
    (tmp_path / "pad.toml").write_bytes(GOOD.replace("um", "µm").encode("latin-1"))
    refused(tmp_path, capsys, "pad.toml, line 4: the byte 0xb5 is not UTF-8")


def test_parameters_and_a_file_exclude_each_other(tmp_path, capsys):
    path = tmp_path / "pad.toml"
    path.write_text(GOOD)
    assert main(["solve", "--model", "jkr", "--quantity", "pull_off_force", "--mu", "1", "--problem", str(path)]) == 2
    assert "--mu and --problem exclude each other" in capsys.readouterr().err


def test_values_are_those_in_si(tmp_path):
    (tmp_path / "pad.toml").write_text(GOOD)
    found = load_problem(tmp_path / "pad.toml")
    plain = GOOD
    for text, number in (("2 GPa", "2e9"), ("1 um", "1e-6"), ("10 nm", "1e-8"), ("2.5 um", "2.5e-6")):
        plain = plain.replace(f'"{text}"', number)
    plain = plain.replace('"50 mJ/m^2"', "0.05").replace('"0.4 nm"', "4e-10")
    (tmp_path / "pad.toml").write_text(plain)
    assert load_problem(tmp_path / "pad.toml") == found
    assert found.solid.values == {"E0": 2e9, "c0": 1e-6, "k": 0.4, "z_s": 1e-8, "nu": 0.3}


@pytest.mark.parametrize("text", ["50 mN/m", "0.05 J/m²".replace("²", "^2"), "50 erg/cm^2", "0.05 J m^-2", "0.05 N/m"])
def test_units_of_a_work_of_adhesion(text, tmp_path):
    (tmp_path / "pad.toml").write_text(GOOD.replace("50 mJ/m^2", text))
    assert math.isclose(load_problem(tmp_path / "pad.toml").law["work_of_adhesion"], 0.05, rel_tol=1e-15)


@pytest.mark.parametrize("text", ["70 deg", "70°", "70 degree", "1.2217304763960306 rad", "4200 arcmin", "7e1 deg"])
def test_units_of_an_angle(text, tmp_path):
    (tmp_path / "pad.toml").write_text(GOOD.replace(PUNCH, f'[punch]\nkind = "cone"\nhalf_angle = "{text}"\n\n'))
    assert math.isclose(load_problem(tmp_path / "pad.toml").punch["half_angle"], math.radians(70.0), rel_tol=1e-15)


def test_a_factor_that_is_no_power_of_ten_keeps_its_digits(tmp_path):
    """An inch is 0.0254 m: its inverse is no whole number."""
    (tmp_path / "pad.toml").write_text(GOOD.replace("2.5 um", "1e-4 inch"))
    assert math.isclose(load_problem(tmp_path / "pad.toml").punch["R"], 2.54e-6, rel_tol=1e-15)


def test_columns_have_units(tmp_path):
    (tmp_path / "pad.toml").write_text(GOOD.replace(SOLID, SOLID_TABLE))
    (tmp_path / "modulus.csv").write_text("# a comment\nE [GPa], z [nm]\n1, 0\n2.5, 20\n")
    columns = load_problem(tmp_path / "pad.toml").solid.columns
    assert np.allclose(columns["z"], [0.0, 2e-8], rtol=1e-15)
    assert np.allclose(columns["E"], [1e9, 2.5e9], rtol=1e-15)
