"""Registry of models: from a name or a SPEC to a model.

The models of this repository are found in the folder `comparisons.models`.  A module there declares its models
in a literal, which is read without importing the module:

    MODELS = {"jkr": "JKR"}  # name -> class

So a command that needs JKR does not load the finite elements, and a new model is one new file.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module
from importlib.resources import files

from comparisons.domain import Domain, declared_domain
from comparisons.external.model_source import load_model, source_of
from comparisons.model import Model

_FOLDER = "comparisons.models"
_LITERAL = re.compile(r"^MODELS = (\{.*?\})$", flags=re.MULTILINE | re.DOTALL)

#: Models whose class takes Poisson's ratio.
_WITH_POISSON_RATIO = ("fem",)

#: Models that come first in lists and tables; the others follow by the name of their module.
_VERIFYING = ("fscm-stieltjes", "fscm-stieltjes-400")
_REFERENCES = ("fscm", *_VERIFYING, "fem")
_OF_THE_PAPER = ("jkr", "md-original", "md-improved", "dmt", "bradley", "semi-rigid")
_OF_OTHERS = ("double-hertz-n-k", "md-jin", "dmt-strength", "carpick-ogletree-salmeron", "pietrement-troyon", "schwarz")
_ORDER = (*_REFERENCES, *_OF_THE_PAPER, *_OF_OTHERS, "jump-asymptotes", "jkr-sphere", "atlas", "fem-large-strain")


def declared_models(source: str) -> dict[str, str]:
    """Return the models that a module declares: name -> class.

    Parameters
    ----------
    source : str
        Text of the module.

    Raises
    ------
    ValueError
        If the value of `MODELS` is not a literal.

    Examples
    --------
    >>> declared_models('MODELS = {"jkr": "JKR"}')
    {'jkr': 'JKR'}
    """
    declaration = _LITERAL.search(source)
    return ast.literal_eval(declaration[1]) if declaration else {}


def _models_in_folder() -> dict[str, str]:
    """Name -> "module:class" of every model in the folder, in the order of lists."""
    models: dict[str, str] = {}
    for entry in sorted(files(_FOLDER).iterdir(), key=lambda entry: entry.name):
        if entry.name.endswith(".py"):
            module = f"{_FOLDER}.{entry.name.removesuffix('.py')}"
            for name, cls in declared_models(entry.read_text(encoding="utf-8")).items():
                if name in models:
                    raise ValueError(f"{module} declares a model {name}, which another module declares as well")
                models[name] = f"{module}:{cls}"
    return {name: models[name] for name in [*(name for name in _ORDER if name in models), *models]}


#: Name -> "module:class"; the class is called without arguments, or with Poisson's ratio alone if it takes it.
MODELS: dict[str, str] = _models_in_folder()

#: The models that a comparison of all has: without other discretisations of `fscm`, which take minutes.
COMPARABLE = tuple(name for name in MODELS if name not in _VERIFYING)


def depends_on_poisson_ratio(name: str) -> bool:
    """Whether the results of a model depend on Poisson's ratio, if only by numerical errors.

    Only a model of physical quantities can: the dimensionless problem has no Poisson's ratio (Eq. 29).

    Examples
    --------
    >>> depends_on_poisson_ratio("fem"), depends_on_poisson_ratio("fscm")
    (True, False)
    """
    return name in _WITH_POISSON_RATIO


def create(name: str, poisson_ratio: float | None = None) -> Model:
    """Return the model registered as `name`, or an external one.

    Parameters
    ----------
    name : str
        A key of `MODELS`, or the SPEC of an external model (see `comparisons.external.model_source`).
    poisson_ratio : float, optional
        Poisson's ratio of the solid, for models that need one; by default the model's own choice.

    Raises
    ------
    ValueError
        If no model has that name (the sentence lists those that exist), or if an external one cannot be loaded.

    Examples
    --------
    >>> create("jkr").name
    'jkr'
    """
    if name not in MODELS:
        return _external_model(name)
    module, _, cls = MODELS[name].partition(":")
    factory = getattr(import_module(module), cls)
    if depends_on_poisson_ratio(name) and poisson_ratio is not None:
        return factory(poisson_ratio)
    return factory()


@dataclass(frozen=True, slots=True)
class ExternalIdentity:
    """Name, version and texts of an external model, and the SPEC that finds it.

    Examples
    --------
    >>> ExternalIdentity("mine", "1", "mine.py:Mine", citation="none", domain="n = 2").spec
    'mine.py:Mine'
    """

    name: str
    version: str
    spec: str
    citation: str
    domain: str
    #: The files that the digest in the version covers, in words.
    hashed: str = ""
    #: The domain that it declares.
    applies_to: Domain | None = None


def identify(specs: Iterable[str]) -> tuple[list[str], dict[str, ExternalIdentity]]:
    """Return the names of models, each once, and the identities of the external ones.

    Raises
    ------
    ValueError
        As `create`; also if two models have one name.

    Examples
    --------
    >>> identify(["jkr", "dmt", "jkr"])
    (['jkr', 'dmt'], {})
    """
    names: list[str] = []
    external: dict[str, ExternalIdentity] = {}
    for spec in dict.fromkeys(specs):
        model = create(spec)
        if model.name in names:
            raise ValueError(f"two models have the name {model.name}: each needs its own name")
        names.append(model.name)
        if spec not in MODELS:
            hashed = str(getattr(model, "hashed", ""))
            external[model.name] = ExternalIdentity(
                model.name, model.version, spec, model.citation, model.domain, hashed, declared_domain(model)
            )
    return names, external


def _external_model(spec: str) -> Model:
    try:
        source_of(spec)
    except ValueError as error:
        raise ValueError(f"unknown model: {error}; the models are {', '.join(MODELS)}") from None
    model = load_model(spec)
    if model.name in MODELS:
        raise ValueError(
            f"the name {model.name} of the external model belongs to a model of fscm-bench: choose another name"
        )
    return model
