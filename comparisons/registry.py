"""The registry of models: from a name or a SPEC to a model.

A model is looked up by the name a user types and imported only then: asking JKR for a pull-off force does
not load the finite elements.  To add a model, write its module and add one row here.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module

from comparisons.external.model_source import load_model, source_of
from comparisons.model import Model

__all__ = ["MODELS", "ExternalIdentity", "create", "identify", "knows_poisson"]

#: name -> "module:class"; the class is called without arguments, or with the Poisson's ratio alone if it
#: is in `_KNOWS_POISSON`.
MODELS: dict[str, str] = {
    "fscm": "comparisons.models.fscm_model:FullSelfConsistent",
    "fscm-stieltjes": "comparisons.models.stieltjes_model:StieltjesModel",
    "fscm-stieltjes-400": "comparisons.models.stieltjes_model:CoarseStieltjesModel",
    "fem": "comparisons.models.fem_model:FiniteElements",
    "jkr": "comparisons.models.jkr:JKR",
    "md-original": "comparisons.models.maugis_dugdale:MaugisDugdaleOriginal",
    "md-improved": "comparisons.models.maugis_dugdale:MaugisDugdaleImproved",
    "dmt": "comparisons.models.dmt:DMT",
    "bradley": "comparisons.models.bradley:Bradley",
    "semi-rigid": "comparisons.models.semi_rigid:SemiRigid",
}

#: Models that work with physical quantities.  The dimensionless problem has no Poisson's ratio (Eq. 29 has
#: absorbed it), so every other model gives the same answer for all of them.
_KNOWS_POISSON = frozenset({"fem"})


def knows_poisson(name: str) -> bool:
    """Whether the answers of a model depend on Poisson's ratio, if only numerically.

    Examples
    --------
    >>> knows_poisson("fem"), knows_poisson("fscm")
    (True, False)
    """
    return name in _KNOWS_POISSON


def create(name: str, poisson_ratio: float | None = None) -> Model:
    """Return the model registered as `name`, or one from outside.

    Parameters
    ----------
    name : str
        A key of `MODELS`, or the SPEC of a model from outside (see `comparisons.external.model_source`).
    poisson_ratio : float, optional
        Poisson's ratio of the solid, for models that need one; by default the model's own choice.

    Raises
    ------
    ValueError
        If no model has that name, the sentence lists those that exist; or if one from outside cannot be
        loaded.

    Examples
    --------
    >>> create("jkr").name
    'jkr'
    """
    if name not in MODELS:
        return _external_model(name, poisson_ratio)
    module, _, cls = MODELS[name].partition(":")
    factory = getattr(import_module(module), cls)
    if knows_poisson(name) and poisson_ratio is not None:
        return factory(poisson_ratio)
    return factory()


@dataclass(frozen=True, slots=True)
class ExternalIdentity:
    """A model from outside by what it says of itself, and the SPEC that finds it.

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
    #: Which of its files the digest in the version is of, in words.
    hashed: str = ""


def identify(specs: Iterable[str]) -> tuple[list[str], dict[str, ExternalIdentity]]:
    """Return the names of models, each once, and which of them are from outside.

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
    outside: dict[str, ExternalIdentity] = {}
    for spec in dict.fromkeys(specs):
        model = create(spec)
        if model.name in names:
            raise ValueError(f"two models are called {model.name}: each needs its own name")
        names.append(model.name)
        if spec not in MODELS:
            hashed = str(getattr(model, "hashed", ""))
            outside[model.name] = ExternalIdentity(
                model.name, model.version, spec, model.citation, model.domain, hashed
            )
    return names, outside


def _external_model(spec: str, poisson_ratio: float | None) -> Model:
    try:
        source_of(spec)
    except ValueError as error:
        raise ValueError(f"unknown model: {error}; the models are {', '.join(MODELS)}") from None
    model = load_model(spec, poisson_ratio)
    if model.name in MODELS:
        raise ValueError(f"a model from outside calls itself {model.name}, which is one of ours")
    return model
