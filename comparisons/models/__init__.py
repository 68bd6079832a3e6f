"""One module a model, and the register of their names.

A model is looked up by the name a user types and imported only then: asking JKR for a pull-off force does
not load the finite elements.  To add a model, write its module and add one row here.
"""

from __future__ import annotations

from importlib import import_module

from comparisons.model import Model

__all__ = ["MODELS", "create", "knows_poisson"]

#: name -> "module:class"; the class is called without arguments, or with the Poisson's ratio alone if it
#: is in `_KNOWS_POISSON`.
MODELS: dict[str, str] = {
    "fscm": "comparisons.models.fscm_model:FullSelfConsistent",
    "fscm-stieltjes": "comparisons.models.stieltjes_model:PublishedScheme",
    "fscm-stieltjes-400": "comparisons.models.stieltjes_model:CoarsePublishedScheme",
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
    """Whether the answers of a model depend on Poisson's ratio, if only numerically."""
    return name in _KNOWS_POISSON


def create(name: str, poisson_ratio: float | None = None) -> Model:
    """Return the model registered as `name`.

    Parameters
    ----------
    name : str
        A key of `MODELS`.
    poisson_ratio : float, optional
        Poisson's ratio of the solid, for models that need one; by default the model's own choice.

    Raises
    ------
    ValueError
        If no model has that name; the sentence lists those that exist.

    Examples
    --------
    >>> create("jkr").name
    'jkr'
    """
    if name not in MODELS:
        raise ValueError(f"unknown model {name!r}; the models are {', '.join(MODELS)}")
    module, _, cls = MODELS[name].partition(":")
    factory = getattr(import_module(module), cls)
    if knows_poisson(name) and poisson_ratio is not None:
        return factory(poisson_ratio)
    return factory()
