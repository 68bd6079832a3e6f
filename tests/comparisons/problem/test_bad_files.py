"""Every bad problem file gets one sentence with file, line, key and remedy, and exit status 2."""

import math

import numpy as np
import pytest

from comparisons.cli.main import main
from comparisons.problem.reading import load_problem

SOLID = """\
[solid]
kind = "offset-power-law"
E0 = "2 GPa"
c0 = "1 um"
k = 0.4
z_s = "10 nm"
nu = 0.3

"""
PUNCH = '[punch]\nkind = "sphere"\nR = "2.5 um"\n\n'
LAW = '[law]\nkind = "lennard-jones-9-3"\nwork_of_adhesion = "50 mJ/m^2"\nz0 = "0.4 nm"\n'
GOOD = SOLID + PUNCH + LAW

SOLID_TABLE = '[solid]\nkind = "table"\nfile = "modulus.csv"\nnu = 0.3\n\n'
PUNCH_TABLE = '[punch]\nkind = "table"\nfile = "profile.csv"\n\n'
LAW_TABLE = '[law]\nkind = "table"\nfile = "law.csv"\n'
COATING = '[solid]\nkind = "coating"\nE_coating = 1e9\nE_substrate = 1e10\nthickness = 1e-8\ntransition = 0\n'

#: Values of keys of GOOD that are refused, and what the sentence says besides line and key.
BAD_VALUES = [
    *[(3, "E0", value, "has no unit") for value in ('"2"', '"[1, 2]"', '"2 GPa +- 0.1"')],
    *[(3, "E0", f'"{text}"', "unit nm") for text in ("2 nm", "2 GPa +- 1 nm")],
    (3, "E0", '"2 GPascals"', "GPascals"),
    (3, "E0", f'"2 {"G" * 5000}Pa"', "GGG..."),
    (3, "E0", '"2 m**9**9**9"', "product of units"),
    (3, "E0", '"2,5 GPa"', "comma"),
    (3, "E0", '"GPa"', "number"),
    *[(3, "E0", f'"2 GPa +- {size}"', "deviation") for size in ("0 %", "0 GPa", "-5 %", "0.1 +- 1 GPa")],
    *[(3, "E0", f'"{text}"', "outside its range") for text in ("2 GPa +- 3 GPa", "[0, 2] GPa", "-2 GPa")],
    (3, "E0", '"[2, 1] GPa"', "interval"),
    *[
        (3, "E0", value, "positive modulus")
        for value in ("0", "true", "[1.0, 2.0]", "nan", f"1{'0' * 400}", "2024-01-01")
    ],
    *[(3, "E0", value, "finite") for value in ("inf", '"1e999 GPa"')],
    (3, "E0", f"1{'0' * 5000}", "digits"),
    (5, "k", '"0.4"', "plain number"),
    (5, "k", '"0.4 +- 1 nm"', "plain number"),
    *[(5, "k", value, "below 1") for value in ("1.4", "1.0", "-0.1")],
    (6, "z_s", '"1e-200 nm"', "1e-20 to"),
    *[(7, "nu", value, "0.5") for value in ("0.6", '"[0.4, 0.6]"')],
    (11, "R", '"1e200 m"', "1e+20 m"),
    (10, "kind", '"sphare"', "did you mean sphere?"),
    (10, "kind", "3", "sphere"),
]

#: Name -> text that is replaced, its replacement, and parts of the sentence in their order.
BAD_TEXT = {
    "unknown key": ("z_s =", "zs =", ["line 6", "'zs'", "did you mean z_s?"]),
    "missing key": ('c0 = "1 um"\n', "", ["line 1", "c0", "E0, c0, k, z_s, nu"]),
    "right angle": (PUNCH, '[punch]\nkind = "cone"\nhalf_angle = "90 deg"\n', ["line 11", "half_angle", "deg"]),
    "degrees as radians": (PUNCH, '[punch]\nkind = "cone"\nhalf_angle = 70\n', ["line 11", "70", "deg"]),
    "percent": (PUNCH, '[punch]\nkind = "cone"\nhalf_angle = "70 percent"\n', ["line 11", "angle"]),
    "no kind": ('kind = "sphere"\n', "", ["line 9", "kind missing", "sphere"]),
    "unknown section": ("[law]", "[lawn]", ["line 13", "'lawn'", "did you mean law?"]),
    "missing section": (LAW, "", ["law missing"]),
    "section that is no table": (GOOD, f"law = 3\n{SOLID}{PUNCH}", ["line 1", "law = 3", "[law]"]),
    "list of sections": ("[solid]", "[[solid]]", ["line 1", "[solid] in single brackets"]),
    "no TOML": ('R = "2.5 um"', "R = 2.5 um", ["is not TOML", "line 11"]),
    "empty": (GOOD, "", ["solid, punch, law missing"]),
    "punch of another scale": ('"2.5 um"', '"2.5e6 m"', ["line 11", "6.2e+15 times the range", "units"]),
    "law of another scale": ('"0.4 nm"', "400.0", ["line 11", "6.3e-09 times the range", "units"]),
    "modulus of another scale": ('"2 GPa"', '"2e-25 GPa"', ["pad.toml", "Tabor number", "units"]),
    "attraction without end": (LAW, LAW.replace("lennard-jones-9-3", "mie") + "m = 9\nn = 1\n", ["law.n = 1"]),
    "repulsion too weak": (LAW, LAW.replace("lennard-jones-9-3", "mie") + "m = 3\nn = 6\n", ["line 13", "repulsion"]),
    "one of two ratios": (SOLID, f"{COATING}nu_coating = 0.3\n\n", ["line 1", "nu_coating and nu_substrate"]),
    "all ratios": (SOLID, f"{COATING}nu = 0.2\nnu_coating = 0.3\n\n", ["line 1", "nu or else nu_coating"]),
    "lengths of lists": (
        SOLID,
        '[solid]\nkind = "layers"\nE = [1e9, 2e9]\nnu = [0.3, 0.3]\nthickness = [1e-9, 1e-9]\n\n',
        ["line 1", "solid", "one entry more"],
    ),
    "an empty list": (SOLID, '[solid]\nkind = "layers"\nE = []\nnu = []\nthickness = []\n\n', ["solid.E"]),
    "an uncertain entry": (
        SOLID,
        '[solid]\nkind = "layers"\nE = ["1 GPa +- 5 %", 2e9]\nnu = [0.3, 0.3]\nthickness = [1e-9]\n\n',
        ["line 3", "solid.E", "uncertainty"],
    ),
    "a power of a length": (
        PUNCH,
        '[punch]\nkind = "power-law"\nn = 3\nQ = "1 um"\n\n',
        ["line 12", "unit um", "m^(2)"],
    ),
    "a long name": (PUNCH, PUNCH_TABLE.replace("profile", "a" * 5000), ["line 11", "punch.file", "not in the folder"]),
    "a name with a NUL": (PUNCH, PUNCH_TABLE.replace("profile", "a\\u0000b"), ["line 11", "is not in the folder"]),
}

MODULUS, PROFILE, TRACTION = (SOLID, SOLID_TABLE), (PUNCH, PUNCH_TABLE), (LAW, LAW_TABLE)
#: Name -> the section and its kind with a table, the content of the table, and parts of the sentence.
BAD_TABLES = {
    "missing table": (MODULUS, None, ["pad.toml, line 3", "'modulus.csv' is not in the folder"]),
    "empty table": (MODULUS, "\n", ["modulus.csv", "empty"]),
    "no names": (MODULUS, "0,1e9\n1e-8,2e9\n", ["line 1", "name of a column"]),
    "one row": (MODULUS, "z,E\n0,1e9\n", ["pad.toml, line 3", "at least two"]),
    "not sorted": (MODULUS, "z,E\n0,1\n2,1\n1,3\n", ["line 4", "z = '1'", "sort the rows"]),
    "a step": (MODULUS, "z,E\n0,1\n2,1\n2,3\n", ["line 4", "z = '2'", "layers"]),
    "not a number": (MODULUS, "z,E\n0,1\n1,nan\n", ["line 3", "E = 'nan'"]),
    "word": (MODULUS, "z,E\n0,1\n1,soft\n", ["line 3", "E = 'soft'"]),
    "negative": (MODULUS, "z,E\n0,1\n1,-2\n", ["line 3", "E = '-2'"]),
    "ratio": (MODULUS, "z,E,nu\n0,1,0.3\n1,2,0.6\n", ["line 3", "nu = '0.6'", "0.5"]),
    "huge modulus": (MODULUS, "z,E\n0,1\n1,1e300\n", ["line 3", "E = '1e300'", "1e+20 Pa"]),
    "small modulus": (MODULUS, "z,E\n0,1\n1,1e-300\n", ["line 3", "E = '1e-300'", "1e-20 to"]),
    "huge depth": (MODULUS, "z [nm],E\n0,1\n1e300,2\n", ["line 3", "z = '1e300'", "1e+20 m"]),
    "huge traction": (TRACTION, "gap,traction\n1e-10,1e300\n", ["line 2", "traction = '1e300'"]),
    "short row": (MODULUS, "z,E\n0,1\n1\n", ["line 3", "1 values for 2 columns"]),
    "unknown column": (MODULUS, "z,Emod\n0,1\n", ["line 1", "'Emod'"]),
    "missing column": (MODULUS, "z\n0\n", ["line 1", "column E is missing"]),
    "a column twice": (MODULUS, "z,E,E\n0,1,1\n", ["line 1", "column E stands twice"]),
    "wrong unit": (MODULUS, "z [GPa],E\n0,1\n1,2\n", ["line 1", "column z has the unit GPa"]),
    "two ratios": (MODULUS, "z,E,nu\n0,1,0.3\n1,2,0.3\n", ["pad.toml, line 3", "nu is needed once"]),
    "short profile": (PROFILE, "r [um],height [nm]\n0,0\n1,0.2\n", ["inside the contact", "further out"]),
    "no apex": (PROFILE, "r,height\n1e-7,1e-8\n2e-7,4e-8\n", ["pad.toml, line 11", "(0, 0)"]),
    "hollow": (PROFILE, "r,height\n0,0\n2e-7,-4e-8\n", ["line 11", "last height"]),
    "a long cell": (PROFILE, f"r,height\n0,{'1' * 200_000}\n", ["line 2", "no row of CSV"]),
    "few rows to smooth": (
        (PUNCH, PUNCH_TABLE.replace("\n\n", '\nsmoothing = "1 nm"\n\n')),
        "r,height\n0,0\n1e-6,1e-6\n",
        ["line 11", "at least 8"],
    ),
    "short law": (TRACTION, "gap,traction\n0,1\n1,-1\n", ["pad.toml, line 15", ">= 10"]),
    "law without attraction": (
        TRACTION,
        "gap [nm],traction [MPa]\n" + "".join(f"{i},{10 / i}\n" for i in range(1, 12)),
        ["line 15", "traction"],
    ),
}


def refused(folder, capsys, *parts):
    """The one sentence of the command for the file of a folder; it has the parts in their order."""
    status = main(["solve", "--model", "fscm", "--quantity", "pull_off_force", "--problem", str(folder / "pad.toml")])
    captured = capsys.readouterr()
    assert (status, captured.out, captured.err.count("\n")) == (2, "", 1)
    position = 0
    for text in parts:
        position = captured.err.find(text, position)
        assert position >= 0, f"{text!r} is not in {captured.err!r}"
    return captured.err


@pytest.mark.parametrize(("line", "key", "value", "reason"), BAD_VALUES, ids=lambda value: str(value)[:30])
def test_bad_values(line, key, value, reason, tmp_path, capsys):
    lines = GOOD.splitlines()
    assert lines[line - 1].startswith(f"{key} = ")
    lines[line - 1] = f"{key} = {value}"
    (tmp_path / "pad.toml").write_text("\n".join(lines))
    name = [] if reason == "digits" else [f"{'solid' if line < 9 else 'punch'}.{key} = "]
    assert len(refused(tmp_path, capsys, "pad.toml", f"line {line}", *name, reason)) < 500


@pytest.mark.parametrize("name", BAD_TEXT)
def test_bad_text(name, tmp_path, capsys):
    old, new, parts = BAD_TEXT[name]
    assert old in GOOD
    (tmp_path / "pad.toml").write_text(GOOD.replace(old, new))
    assert "pad.toml" in refused(tmp_path, capsys, *parts)


@pytest.mark.parametrize("name", BAD_TABLES)
def test_bad_tables(name, tmp_path, capsys):
    (section, with_table), content, parts = BAD_TABLES[name]
    (tmp_path / "pad.toml").write_text(GOOD.replace(section, with_table))
    if content is not None:
        (tmp_path / with_table.split('"')[3]).write_text(content)
    refused(tmp_path, capsys, *parts)


@pytest.mark.parametrize(("share", "is_refused"), [(0.95, True), (1.05, False)])
def test_a_profile_reaches_as_high_as_the_contact(share, is_refused, tmp_path, capsys):
    """To (1 + mu) z0, here of a paraboloid with a radius of 2.5 um."""
    path = tmp_path / "pad.toml"
    path.write_text(GOOD)
    height = share * (1.0 + load_problem(path).posed.mu) * 0.4e-9
    rows = "".join(f"{r!r},{r**2 / 5e-6!r}\n" for r in np.linspace(0.0, math.sqrt(5e-6 * height), 50).tolist())
    path.write_text(GOOD.replace(PUNCH, PUNCH_TABLE))
    (tmp_path / "profile.csv").write_text(f"r,height\n{rows}")
    if is_refused:
        refused(tmp_path, capsys, "line 11", "inside the contact")
    else:
        assert load_problem(path).punch.kind == "table"


def test_a_file_that_is_missing_and_a_folder(tmp_path, capsys):
    refused(tmp_path, capsys, "pad.toml: the problem file cannot be read (No such file or directory)")
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
    assert secret not in refused(folder, capsys, "line 3", f"solid.file = '{name[:20]}", "is not in the folder")


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


@pytest.mark.parametrize("name", ["-", "a\0b", "x" * 5000], ids=["standard input", "NUL", "long"])
def test_a_name_that_is_no_file(name, capsys):
    assert main(["describe", name]) == 2
    assert "the problem file " in capsys.readouterr().err


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
    problem = load_problem(tmp_path / "pad.toml")
    plain = GOOD
    for text, number in (("2 GPa", "2e9"), ("1 um", "1e-6"), ("10 nm", "1e-8"), ("2.5 um", "2.5e-6")):
        plain = plain.replace(f'"{text}"', number)
    plain = plain.replace('"50 mJ/m^2"', "0.05").replace('"0.4 nm"', "4e-10")
    (tmp_path / "pad.toml").write_text(plain)
    assert load_problem(tmp_path / "pad.toml") == problem
    assert problem.solid.values == {"E0": 2e9, "c0": 1e-6, "k": 0.4, "z_s": 1e-8, "nu": 0.3}


CONE = (PUNCH, '[punch]\nkind = "cone"\nhalf_angle = "{}"\n\n')


@pytest.mark.parametrize(
    ("key", "old", "new", "texts", "value"),
    [
        ("law.work_of_adhesion", "50 mJ/m^2", "{}", ["50 mN/m", "50 erg/cm^2", "0.05 J m^-2", "0.05 N/m"], 0.05),
        ("punch.half_angle", *CONE, ["70 deg", "70°", "1.2217304763960306 rad", "4200 arcmin"], math.radians(70)),
        # An inch is 0.0254 m: its inverse is no whole number.
        ("punch.R", "2.5 um", "{}", ["1e-4 inch", "2.54 µm", "25400 Å"], 2.54e-6),
    ],
)
def test_units(key, old, new, texts, value, tmp_path):
    for text in texts:
        (tmp_path / "pad.toml").write_text(GOOD.replace(old, new.format(text)), encoding="utf-8")
        assert math.isclose(load_problem(tmp_path / "pad.toml")[key], value, rel_tol=1e-15)


def test_columns_have_units(tmp_path):
    (tmp_path / "pad.toml").write_text(GOOD.replace(SOLID, SOLID_TABLE))
    (tmp_path / "modulus.csv").write_text("# a comment\nE [GPa], z [nm]\n1, 0\n2.5, 20\n")
    columns = load_problem(tmp_path / "pad.toml").solid.columns
    assert np.allclose(columns["z"], [0.0, 2e-8], rtol=1e-15)
    assert np.allclose(columns["E"], [1e9, 2.5e9], rtol=1e-15)
