"""The problem file that `new-problem` writes: sections of the kinds that are named, with a comment on each key."""

from __future__ import annotations

import json
from collections.abc import Iterable

from comparisons.data.toml_text import shipped
from comparisons.data.validation import known_name
from comparisons.problem.kinds import KINDS, PUNCH_SOLID, SECTIONS, Kind, known_word

#: Kinds of the sections that are not named.
_DEFAULTS = {"solid": "homogeneous", "punch": "sphere", "law": "lennard-jones-9-3"}

#: Optional keys that the file of a kind states: a profile without smoothing has a kink at every row, and a table of the
#: modulus without a column nu needs it here.
_STATED = {"punch.table": ("smoothing",), "solid.table": ("nu",), f"{PUNCH_SOLID}.table": ("nu",)}

#: First lines of a file.
_HEAD = """\
# Values are texts with a unit, as "2 GPa" or "2 +- 0.1 GPa", or plain numbers in SI.
# A line with # in front has no effect.
"""


def problem_template(names: Iterable[str]) -> dict[str, str]:
    """Return the text of a problem file under the name "", and those of its tables under theirs.

    Parameters
    ----------
    names : iterable of str
        Kinds such as "coating", or "solid.table" where several sections have a kind of this name.

    Raises
    ------
    ValueError
        One sentence, for an unknown kind, one of several sections, or a section that is named twice.

    Examples
    --------
    >>> print(problem_template(["cone"])[""].partition("[punch]")[2].partition("[law]")[0].strip())
    # r/tan(half_angle)
    kind = "cone"
    half_angle = "70 deg"  # an angle between axis and flank, above 0 and below 90 degrees
    """
    chosen: dict[str, str] = {}
    for name in names:
        section, kind = _section_of(name)
        if section in chosen:
            raise ValueError(f"{chosen[section]} and {kind} are both a {section}; a problem has one")
        chosen[section] = kind
    kinds = {name: chosen.get(name, default) for name, default in _DEFAULTS.items()}
    if PUNCH_SOLID in chosen:
        kinds[PUNCH_SOLID] = chosen[PUNCH_SOLID]
    sections = [_section(section, kind) for section, kind in kinds.items()]
    sections.insert(0, _HEAD)
    tables = shipped("start_values.toml")["tables"]
    used = {str(value) for section, kind in kinds.items() for value in _values(section, kind).values()}
    return {"": "\n".join(sections)} | {name: tables[name].lstrip() for name in tables if name in used}


def _section_of(name: str) -> tuple[str, str]:
    """Section and kind of a name."""
    section, _, kind = name.partition(".")
    if kind:
        known_name("section", section, KINDS, name)
        known_word("kind", kind, KINDS[section], name)
        return section, kind
    if name in KINDS:
        kinds = " or ".join(f"{name}.{kind}" for kind in KINDS[name])
        raise ValueError(f"{name} is a section, of which a kind is named: write {kinds}")
    having = [section for section in SECTIONS if name in KINDS[section]]
    if len(having) > 1:
        raise ValueError(
            f"{name} is a kind of {' and of '.join(having)}: write {' or '.join(f'{s}.{name}' for s in having)}"
        )
    known_word("kind", name, sorted({kind for section in SECTIONS for kind in KINDS[section]}), "new-problem")
    return having[0], name


def _values(section: str, kind: str) -> dict[str, object]:
    table = shipped("start_values.toml")["solid" if section == PUNCH_SOLID else section]
    values: dict[str, object] = table[kind]
    return values


def _section(section: str, name: str) -> str:
    kind, values = KINDS[section][name], _values(section, name)
    stated = [*kind.required, *(kind.choices[0] if kind.choices else ()), *_STATED.get(f"{section}.{name}", ())]
    lines = [f"[{section}]", f"# {kind.formula}", f'kind = "{name}"']
    lines += [_line(kind, key, values) for key in stated]
    others = [key for key in kind.keys if key not in stated]
    lines += [f"# {_line(kind, key, values)}" for key in others]
    return "\n".join(lines) + "\n"


def _line(kind: Kind, key: str, values: dict[str, object]) -> str:
    """A key with its value and what it may be."""
    form = kind.keys[key]
    value = values.get(key, form.example or (form.words[0] if form.words else None))
    instead = next((f"in place of {', '.join(kind.choices[0])}: " for group in kind.choices[1:] if key in group), "")
    note = "optional: " if key in kind.optional else instead
    described = f"{form.description}, for each layer" if form.is_list else form.description
    return f"{key} = {json.dumps(value)}  # {note}{described}"
