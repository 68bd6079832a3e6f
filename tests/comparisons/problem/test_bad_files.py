"""Every bad problem file gets one sentence with file, line, key and remedy, and exit status 2."""

import math
import re

import numpy as np
import pytest

from comparisons.problem.punch_shapes import SmoothedProfile
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


def cone(half_angle):
    return f'[punch]\nkind = "cone"\nhalf_angle = {half_angle}\n\n'


def mie(m, n):
    return LAW.replace("lennard-jones-9-3", "mie") + f"m = {m}\nn = {n}\n"


def layers(moduli, ratios, thicknesses):
    return f'[solid]\nkind = "layers"\nE = {moduli}\nnu = {ratios}\nthickness = {thicknesses}\n\n'


#: Values of keys of GOOD that are refused, and what the sentence says besides line and key.
BAD_VALUES = [
    *[(3, "E0", value, "has no unit") for value in ('"2"', '"[1, 2]"', '"2 GPa +- 0.1"')],
    *[(3, "E0", f'"{text}"', "unit nm") for text in ("2 nm", "2 GPa +- 1 nm", "2(1) nm", "2 +- 5 % nm")],
    (3, "E0", '"2 GPascals"', "GPascals"),
    (3, "E0", f'"2 {"G" * 5000}Pa"', "GGG..."),
    (3, "E0", '"2 m**9**9**9"', "product of units"),
    (3, "E0", '"2,5 GPa"', "comma"),
    (3, "E0", '"GPa"', "number"),
    *[(3, "E0", f'"2 GPa +- {size}"', "deviation") for size in ("0 %", "0 GPa", "-5 %", "0.1 +- 1 GPa")],
    *[(3, "E0", f'"{text}"', "outside its range") for text in ("2 GPa +- 3 GPa", "[0, 2] GPa", "-2 GPa")],
    (3, "E0", '"[2, 1] GPa"', "interval"),
    *[(3, "E0", value, "positive modulus") for value in ("0", "true", "[1.0, 2.0]", "nan", f"1{'0' * 400}")],
    *[(3, "E0", value, "MPa megapascal") for value in ('"2 mPa"', '"2 mPa +- 5 %"')],
    *[(3, "E0", value, "finite") for value in ("inf", '"1e999 GPa"')],
    (5, "k", '"0.4"', "plain number"),
    (5, "k", '"0.4 +- 1 nm"', "plain number"),
    *[(5, "k", value, "below 1") for value in ("1.4", "1.0", "-0.1")],
    (6, "z_s", '"1e-200 nm"', "1e-20 to"),
    *[(7, "nu", value, "0.5") for value in ("0.6", '"[0.4, 0.6]"')],
    (11, "R", '"1e200 m"', "1e+20 m"),
    (3, "E0", '"2 Gpa"', "did you mean GPa?"),
    (3, "E0", '"2 mpa"', "did you mean MPa?"),
    (6, "z_s", '"10 NM"', "did you mean nm?"),
    (10, "kind", '"flat"', "rounded-flat"),
    (10, "kind", '"sphare"', "did you mean sphere?"),
    (10, "kind", '"paraboloid"', "did you mean sphere?"),
    (10, "kind", "3", "sphere"),
]

#: A text that is replaced, its replacement, and parts of the sentence in their order.
BAD_TEXT = [
    ("E0 =", "modulus =", ["line 3", "'modulus'", "did you mean E0?"]),
    ("R =", "radius =", ["line 11", "'radius'", "did you mean R?"]),
    ('"lennard-jones-9-3"', '"lj"', ["line 14", "'lj'", "did you mean lennard-jones-9-3?"]),
    ("z_s =", "zs =", ["line 6", "'zs'", "did you mean z_s?"]),
    ('c0 = "1 um"\n', "", ["line 1", "c0", "E0, c0, k, z_s, nu"]),
    (PUNCH, cone('"90 deg"'), ["line 11", "half_angle", "deg"]),
    ('kind = "sphere"\n', "", ["line 9", "kind missing", "sphere"]),
    ("[punch]", "[tip]", ["line 9", "'tip'", "[punch]"]),
    ("R =", "D =", ["line 11", "punch.D", "half the diameter"]),
    ('R = "2.5 um"', 'R = "2.5 um"\nRq = "1 nm"', ["line 12", "punch.Rq", "surfaces are smooth here"]),
    ("z_s =", "Sa =", ["line 6", "solid.Sa", "surfaces are smooth here"]),
    ("work_of_adhesion =", "gamma =", ["line 15", "law.gamma", "2 gamma"]),
    ("work_of_adhesion =", "hamaker_constant =", ["line 15", "law.hamaker_constant", "sqrt(A/(16 pi w))"]),
    ("mJ/m^2", "mJ/m2", ["line 15", "did you mean mJ/m^2?"]),
    ('"lennard-jones-9-3"', '"jkr"', ["line 14", "'jkr'", "--model jkr"]),
    ("[law]", "[lawn]", ["line 13", "'lawn'", "did you mean law?"]),
    (GOOD, f"law = 3\n{SOLID}{PUNCH}", ["line 1", "law = 3", "[law]"]),
    ("[solid]", "[[solid]]", ["line 1", "[solid] in single brackets"]),
    ('R = "2.5 um"', "R = 2.5 um", ["is not TOML", "line 11", 'R = "2.5 um"']),
    ('"2 GPa"', f"1{'0' * 5000}", ["is not TOML", "digits"]),
    (GOOD, "", ["solid, punch, law missing"]),
    # Scales that do not fit together.
    ('"2.5 um"', '"2.5e6 m"', ["line 11", "6.2e+15 times the range", "units"]),
    (PUNCH, '[punch]\nkind = "power-law"\nn = 3\nQ = "1e-27 m^2"\n\n', ["line 12", "7.9e-05 times the range", "units"]),
    ('"50 mJ/m^2"', '"1e15 J/m^2"', ["pad.toml", "Tabor number", "units"]),
    (LAW, mie(3, 6), ["line 13", "repulsion"]),
    (LAW, mie(9, 1), ["law.n = 1"]),
    (SOLID, layers("[]", "[]", "[]"), ["solid.E"]),
    (SOLID, f"{COATING}nu_coating = 0.3\n\n", ["line 1", "nu_coating and nu_substrate"]),
    (SOLID, f"{COATING}nu = 0.2\nnu_coating = 0.3\n\n", ["line 1", "nu or else nu_coating"]),
    (SOLID, layers("[1e9, 2e9]", "[0.3, 0.3]", "[1e-9, 1e-9]"), ["line 1", "solid", "one entry more"]),
    (SOLID, layers('["1 GPa +- 5 %", 2e9]', "[0.3, 0.3]", "[1e-9]"), ["line 3", "solid.E", "uncertainty"]),
    (PUNCH, '[punch]\nkind = "power-law"\nn = 3\nQ = "1 um"\n\n', ["line 12", "unit um", "m^(2)"]),
    # Two bodies and what their surfaces have.
    (PUNCH, f"{PUNCH.strip()}\nE = 7e10\nnu = 0.2\n\n", ["line 12", "punch.E", "shape", "[punch_solid]"]),
    (PUNCH, f'{PUNCH.strip()}\nsurface_tension = "1 N/m"\n\n', ["line 12", "surface_tension", "[punch_solid]"]),
    (PUNCH, f'{cone(1.2).strip()}\nR_solid = "3 um"\n\n', ["line 12", "R_solid", "sphere", "not of cone"]),
    ("nu = 0.3\n", 'nu = 0.3\nfriction = "rough"\n', ["line 8", "solid.friction", "'rough'", "none, bonded"]),
    ("nu = 0.3\n", "nu = 0.3\nfriction = 0.3\n", ["line 8", "solid.friction", "0.3", "none, bonded"]),
    ("nu = 0.3\n", 'nu = 0.3\nsurface_tension = "-20 mN/m"\n', ["line 8", "outside its range", "0 or more"]),
    ("nu = 0.3\n", 'nu = 0.3\nsurface_tension = "20 mN"\n', ["line 8", "unit mN", "N/m"]),
    (
        GOOD,
        GOOD.replace("nu = 0.3\n", 'nu = 0.3\nfriction = "bonded"\n')
        + '[punch_solid]\nkind = "homogeneous"\nE = "1 GPa"\nnu = 0.3\n',
        ["line 8", "friction", "rigid punch"],
    ),
    (LAW, f"[punch_solid]\n{LAW}", ["line 13", "punch_solid: kind missing", "homogeneous"]),
    (LAW, f'[punch_solid]\nkind = "sphere"\n\n{LAW}', ["line 14", "punch_solid.kind", "'sphere'"]),
    (LAW, f'[punch_solid]\nkind = "homogeneous"\nE = "70 GPa"\n\n{LAW}', ["line 13", "punch_solid: nu missing"]),
    (
        LAW,
        f'[punch_solid]\nkind = "homogeneous"\nE = "1 GPa"\nnu = 0.3\nfriction = "bonded"\n\n{LAW}',
        ["line 17", "friction", "[solid]"],
    ),
    (PUNCH, PUNCH_TABLE.replace("profile", "a" * 5000), ["line 11", "punch.file", "not in the folder"]),
    (PUNCH, PUNCH_TABLE.replace("profile", "a\\u0000b"), ["line 11", "is not in the folder"]),
]

MODULUS, PROFILE, TRACTION = (SOLID, SOLID_TABLE), (PUNCH, PUNCH_TABLE), (LAW, LAW_TABLE)
SMOOTHED = PUNCH, PUNCH_TABLE.replace("\n\n", '\nsmoothing = "1 nm"\n\n')
REPULSION = "gap [nm],traction [MPa]\n" + "".join(f"{i},{10 / i}\n" for i in range(1, 12))
#: A section and its kind with a table, the content of the table, and parts of the sentence.
BAD_TABLES = [
    (MODULUS, None, ["pad.toml, line 3", "'modulus.csv' is not in the folder"]),
    (MODULUS, "\n", ["modulus.csv", "empty"]),
    (MODULUS, "0;1e9\n1e-8;2e9\n", ["line 1", "name of a column", "separate columns by commas"]),
    (MODULUS, "z [m],E [Pa]\n0,1e9\n", ["pad.toml, line 3", "at least two"]),
    (MODULUS, "z [m],E [Pa]\n0,1\n2,1\n2,3\n", ["line 4", "z = '2'", "layers"]),
    (MODULUS, "z [m],E [Pa]\n0,1\n1,nan\n", ["line 3", "E = 'nan'"]),
    (MODULUS, "z [m],E [Pa]\n0,1\n1,1e30\n", ["line 3", "E = '1e30'", "1e+20 Pa"]),
    (MODULUS, "z [m],E [Pa]\n0,1\n1\n", ["line 3", "1 values for 2 columns"]),
    (MODULUS, "z,Emod\n0,1\n", ["line 1", "'Emod'"]),
    (MODULUS, "z\n0\n", ["line 1", "column E is missing"]),
    (MODULUS, "z [m],E [Pa],E [Pa]\n0,1,1\n", ["line 1", "column E stands twice"]),
    (MODULUS, "z [m],E [Pa]\n0,1\n1,soft\n", ["line 3", "E = 'soft'"]),
    (MODULUS, "z [GPa],E [Pa]\n0,1\n1,2\n", ["line 1", "column z has the unit GPa"]),
    (MODULUS, "z [m],E [Pa],nu\n0,1,0.3\n1,2,0.3\n", ["pad.toml, line 3", "nu is needed once"]),
    (PROFILE, "r [um],height [nm]\n0,0\n1,0.2\n", ["inside the contact", "further out"]),
    (PROFILE, "r [m],height [m]\n1e-7,1e-8\n2e-7,4e-8\n", ["pad.toml, line 11", "(0, 0)"]),
    (PROFILE, "r [m],height [m]\n0,0\n2e-7,-4e-8\n", ["line 11", "last height"]),
    (PROFILE, f"r [m],height [m]\n0,{'1' * 200_000}\n", ["line 2", "no row of CSV"]),
    (PROFILE, "r,height\n0,0\n1,0.2\n", ["line 1", "no unit of r and height", "r [nm],height [nm]"]),
    (PROFILE, "r in nm,height in nm\n0,0\n1,0.2\n", ["line 1", "r [unit],height [unit]"]),
    (PROFILE, "r_nm,height_nm\n0,0\n1,0.2\n", ["line 1", "r_nm", "r [unit]"]),
    (PROFILE, "r [um],height\n0,0\n1,0.2\n", ["line 1", "no unit of height", "r [um],height [nm]"]),
    (PROFILE, "0,0\n1,0.2\n", ["line 1", "'0'", "r [unit],height [unit]"]),
    (SMOOTHED, "r [m],height [m]\n0,0\n1e-6,1e-6\n", ["line 11", "at least 8"]),
    (TRACTION, "gap [m],traction [Pa]\n0,1\n1,-1\n", ["pad.toml, line 15", ">= 10"]),
    (TRACTION, REPULSION, ["line 15", "traction"]),
]


def loaded(folder, old="", new=""):
    """The good problem with a text changed."""
    assert old in GOOD
    (folder / "pad.toml").write_text(GOOD.replace(old, new, 1) if old else GOOD, encoding="utf-8")
    return load_problem(folder / "pad.toml")


def sentence_of(folder, *parts, **changes):
    """The sentence that refuses the file of a folder; it has the parts in their order."""
    with pytest.raises(ValueError, match=".*".join(map(re.escape, parts))) as refusal:
        loaded(folder, **changes) if changes else load_problem(folder / "pad.toml")
    assert "\n" not in str(refusal.value)
    return str(refusal.value)


@pytest.mark.parametrize(("line", "key", "value", "reason"), BAD_VALUES, ids=lambda value: str(value)[:30])
def test_bad_values(line, key, value, reason, tmp_path):
    written = GOOD.splitlines()[line - 1]
    assert written.startswith(f"{key} = ")
    name = [] if key == "kind" else [f"{'solid' if line < 9 else 'punch'}.{key} = "]
    sentence = sentence_of(tmp_path, "pad.toml", f"line {line}", *name, reason, old=written, new=f"{key} = {value}")
    assert len(sentence) < 500


@pytest.mark.parametrize(
    ("R", "is_admitted"), [("0.39 pm", False), ("0.41 pm", True), ("390 m", True), ("410 m", False)]
)
def test_a_radius_is_from_a_thousandth_to_a_million_million_ranges(R, is_admitted, tmp_path):
    if is_admitted:
        assert loaded(tmp_path, '"2.5 um"', f'"{R}"').punch["R"] > 0.0
    else:
        sentence_of(tmp_path, "line 11", "times the range", old='"2.5 um"', new=f'"{R}"')


@pytest.mark.parametrize(("old", "new", "parts"), BAD_TEXT, ids=range(len(BAD_TEXT)))
def test_bad_text(old, new, parts, tmp_path):
    assert "pad.toml" in sentence_of(tmp_path, *parts, old=old, new=new)


@pytest.mark.parametrize(("table", "content", "parts"), BAD_TABLES, ids=range(len(BAD_TABLES)))
def test_bad_tables(table, content, parts, tmp_path):
    if content is not None:
        (tmp_path / table[1].split('"')[3]).write_text(content)
    sentence_of(tmp_path, *parts, old=table[0], new=table[1])


def test_keys_of_a_rigid_punch_are_not_varied(tmp_path, refused):
    (tmp_path / "pad.toml").write_text(GOOD)
    vary = ["--vary", "punch_solid.E=1 GPa, 2 GPa"]
    command = ["sweep", "--problem", tmp_path / "pad.toml", "--model", "jkr", *vary, "--out", tmp_path / "never"]
    refused(command, "no section [punch_solid]")


def test_the_command_has_status_2(tmp_path, refused):
    path = tmp_path / "pad.toml"
    path.write_text(GOOD.replace("2 GPa", "-2 GPa"))
    solve = ["solve", "--model", "jkr", "--quantity", "pull_off_force", "--problem", path]
    refused(solve, f"{path}, line 3")
    refused([*solve, "--mu", "1"], "--mu and --problem exclude each other")


@pytest.mark.parametrize(("share", "is_refused"), [(0.95, True), (1.05, False)])
def test_a_profile_reaches_as_high_as_the_contact(share, is_refused, tmp_path):
    """To (1 + mu) z0, here of a paraboloid with a radius of 2.5 um."""
    height = share * (1.0 + loaded(tmp_path).posed.mu) * 0.4e-9
    rows = "".join(f"{r!r},{r**2 / 5e-6!r}\n" for r in np.linspace(0.0, math.sqrt(5e-6 * height), 50).tolist())
    (tmp_path / "profile.csv").write_text(f"r [m],height [m]\n{rows}")
    if is_refused:
        sentence_of(tmp_path, "line 11", "inside the contact", old=PUNCH, new=PUNCH_TABLE)
    else:
        assert loaded(tmp_path, PUNCH, PUNCH_TABLE).punch.kind == "table"


def test_a_file_that_is_missing_a_folder_or_not_utf_8(tmp_path):
    sentence_of(tmp_path, "pad.toml: the problem file cannot be read (No such file or directory)")
    (tmp_path / "pad.toml").mkdir()
    sentence_of(tmp_path, "pad.toml: the problem file cannot be read")
    (tmp_path / "pad.toml").rmdir()
    (tmp_path / "pad.toml").write_bytes(GOOD.replace("um", "µm").encode("latin-1"))
    sentence_of(tmp_path, "pad.toml, line 4: the byte 0xb5 is not UTF-8")


@pytest.mark.parametrize("name", ["../theirs.csv", "link.csv"])
def test_a_table_outside_the_folder_is_neither_read_nor_shown(name, tmp_path):
    folder = tmp_path / "mine"
    folder.mkdir()
    secret = "first line of theirs"
    (tmp_path / "theirs.csv").write_text(f"{secret}\n1,2\n")
    (folder / "link.csv").symlink_to(tmp_path / "theirs.csv")
    table = SOLID_TABLE.replace("modulus.csv", name)
    parts = "line 3", f"solid.file = '{name[:20]}", "is not in the folder"
    assert secret not in sentence_of(folder, *parts, old=SOLID, new=table)


def test_a_table_in_a_folder_below_is_read(tmp_path):
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "a.csv").write_text("# a comment\nE [GPa], z [nm]\n1, 0\n2.5, 20\n")
    (tmp_path / "tables" / "link.csv").symlink_to(tmp_path / "tables" / "a.csv")
    for name in ("tables/a.csv", "./tables/link.csv"):
        columns = loaded(tmp_path, SOLID, SOLID_TABLE.replace("modulus.csv", name)).solid.columns
        assert np.allclose(columns["z"], [0.0, 2e-8], rtol=1e-15)
        assert np.allclose(columns["E"], [1e9, 2.5e9], rtol=1e-15)


def test_a_word_of_megabytes(tmp_path):
    for old in ("z_s", "sphere"):
        assert len(sentence_of(tmp_path, "pad.toml", "2000000", old=old, new="s" * 2_000_000)) < 500


@pytest.mark.parametrize(
    ("key", "old", "new", "texts", "value"),
    [
        ("solid.E0", '"2 GPa"', "{}", ["2e9", '"2 GPa"', '"2000 MPa"'], 2e9),
        ("law.work_of_adhesion", "50 mJ/m^2", "{}", ["50 mN/m", "50 erg/cm^2", "0.05 J m^-2", "0.05 N/m"], 0.05),
        ("punch.half_angle", PUNCH, cone('"{}"'), ["70 deg", "70°", "1.2217304763960306 rad"], math.radians(70)),
        # An inch is 0.0254 m: its inverse is no whole number.
        ("punch.R", "2.5 um", "{}", ["1e-4 inch", "2.54 µm", "25400 Å"], 2.54e-6),
    ],
)
def test_units(key, old, new, texts, value, tmp_path):
    for text in texts:
        assert math.isclose(loaded(tmp_path, old, new.format(text))[key], value, rel_tol=1e-15)


def test_a_smoothing_that_no_curve_has_is_refused_and_no_library_warns():
    """Heights of metres and a smoothing of nanometres: a unit is wrong.  Whether a spline ends is up to its library."""
    refused = []
    for rows in (20, 40, 60, 100):
        r = np.arange(float(rows))
        heights = r**2 / 40.0 + np.random.default_rng(1).normal(0.0, 0.05, rows) * (r > 0.0)
        for smoothing in (5e-11, 1e-9):
            try:
                SmoothedProfile(tuple(r), tuple(heights), smoothing)
            except ValueError as refusal:
                refused.append(str(refusal))
    assert refused
    assert all("smoothing" in sentence and "units" in sentence for sentence in refused)
