"""Registry of models: from a name or a SPEC to a model.

A module of a model is imported when the model is created, so that a command that needs JKR does not load the finite
elements.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module

from comparisons.domain import Domain, declared_domain
from comparisons.external.model_source import load_model, source_of
from comparisons.model import Model

__all__ = ["MODELS", "ExternalIdentity", "create", "depends_on_poisson_ratio", "identify"]

#: Name -> module of `comparisons.models` and class, in the order of lists and tables: the references, the closed forms
#: of the paper, those of others.  The class is called without arguments, or with Poisson's ratio alone if it takes it.
_CLASSES = {
    "fscm": "fscm_model:FullSelfConsistent",
    "fscm-stieltjes": "stieltjes_model:StieltjesModel",
    "fscm-stieltjes-400": "stieltjes_model:CoarseStieltjesModel",
    "fem": "fem_model:FiniteElements",
    "jkr": "jkr:JKR",
    "md-original": "maugis_dugdale:MaugisDugdaleOriginal",
    "md-improved": "maugis_dugdale:MaugisDugdaleImproved",
    "dmt": "dmt:DMT",
    "bradley": "bradley:Bradley",
    "semi-rigid": "semi_rigid:SemiRigid",
    "double-hertz-n-k": "double_hertz:DoubleHertz",
    "md-jin": "maugis_dugdale:MaugisDugdaleJin",
    "dmt-strength": "dmt:DMTStrength",
    "carpick-ogletree-salmeron": "carpick_ogletree_salmeron:CarpickOgletreeSalmeron",
    "pietrement-troyon": "pietrement_troyon:PietrementTroyon",
    "schwarz": "schwarz:Schwarz",
    "jump-asymptotes": "jump_asymptotes:JumpAsymptotes",
    "jkr-sphere": "jkr_sphere:JKRSphere",
    "atlas": "atlas_model:Atlas",
}

#: Name -> "module:class".
MODELS: dict[str, str] = {name: f"comparisons.models.{path}" for name, path in _CLASSES.items()}

#: Models whose class takes Poisson's ratio.
_WITH_POISSON_RATIO = ("fem",)


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
        return _external_model(name, poisson_ratio)
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


def _external_model(spec: str, poisson_ratio: float | None) -> Model:
    try:
        source_of(spec)
    except ValueError as error:
        raise ValueError(f"unknown model: {error}; the models are {', '.join(MODELS)}") from None
    model = load_model(spec, poisson_ratio)
    if model.name in MODELS:
        raise ValueError(
            f"the name {model.name} of the external model belongs to a model of fscm-bench: choose another name"
        )
    return model
