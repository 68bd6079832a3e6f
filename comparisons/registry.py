"""Registry of models: from a name or a SPEC to a model.

A module is imported when one of its models is created: a command that needs JKR does not load the finite elements.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module

from comparisons.data.validation import nearest_name
from comparisons.domain import Domain, declared_domain
from comparisons.external.model_source import AnyExternalModel, load_model, source_of
from comparisons.model import Model

#: Name -> "module:class", in the order of lists, tables and styles (`comparisons.output.style`).  The class is called
#: without arguments, or with Poisson's ratio alone if it takes it.
MODELS = {
    "fscm": "comparisons.models.fscm_model:FullSelfConsistent",
    "md-improved": "comparisons.models.cohesive_models:MaugisDugdaleImproved",
    "md-original": "comparisons.models.cohesive_models:MaugisDugdaleOriginal",
    "fem": "comparisons.models.fem_model:FiniteElements",
    "jkr": "comparisons.models.jkr:JKR",
    "bradley": "comparisons.models.bradley:Bradley",
    "double-hertz-n-k": "comparisons.models.cohesive_models:DoubleHertz",
    "semi-rigid": "comparisons.models.semi_rigid:SemiRigid",
    "fscm-stieltjes": "comparisons.models.fscm_model:StieltjesModel",
    "fscm-stieltjes-400": "comparisons.models.fscm_model:CoarseStieltjesModel",
    "dmt": "comparisons.models.dmt:DMT",
    "md-jin": "comparisons.models.cohesive_models:MaugisDugdaleJin",
    "dmt-strength": "comparisons.models.dmt:DMTStrength",
    "carpick-ogletree-salmeron": "comparisons.models.transition_formulas:CarpickOgletreeSalmeron",
    "pietrement-troyon": "comparisons.models.transition_formulas:PietrementTroyon",
    "schwarz": "comparisons.models.transition_formulas:Schwarz",
    "jump-asymptotes": "comparisons.models.jump_asymptotes:JumpAsymptotes",
    "atlas": "comparisons.models.atlas:Atlas",
    "jkr-sphere": "comparisons.models.jkr_sphere:JKRSphere",
    "jkr-sphere-projected": "comparisons.models.jkr_sphere:JKRSphereProjected",
    "jkr-profile": "comparisons.models.jkr_profile:JKRProfile",
    "md-profile": "comparisons.models.md_profile:MaugisDugdaleProfile",
    "jkr-surface-tension": "comparisons.models.jkr_surface_tension:JKRSurfaceTension",
    "fem-large-strain": "comparisons.models.fem_model:LargeStrain",
}

#: The models that a comparison of all has: without other discretisations of `fscm`, which take minutes.
COMPARABLE = tuple(name for name in MODELS if not name.startswith("fscm-stieltjes"))


def depends_on_poisson_ratio(name: str) -> bool:
    """Whether the results of a model depend on Poisson's ratio, if only by numerical errors.

    Only a model of physical quantities can: the dimensionless problem has no Poisson's ratio (Eq. 29).

    Examples
    --------
    >>> depends_on_poisson_ratio("fem"), depends_on_poisson_ratio("fscm")
    (True, False)
    """
    return name == "fem"


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
        try:
            source_of(name)
        except ValueError as error:
            # A name of letters: a SPEC that names a file is not written like a model.
            near = "" if set(name) & set(":/\\") else nearest_name(name, MODELS)
            ours = f"did you mean {near}?" if near else f"the models are {', '.join(MODELS)}"
            raise ValueError(f"unknown model: {error}; {ours}") from None
        return external_model(name)
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


def external_model(spec: str) -> AnyExternalModel:
    """Return the external model that a SPEC names; `ValueError` if there is none, or it has the name of one of ours."""
    model = load_model(spec)
    if model.name in MODELS:
        raise ValueError(
            f"the name {model.name} of the external model belongs to a model of fscm-bench: choose another name"
        )
    return model
