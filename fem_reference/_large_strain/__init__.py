"""Contact of a solid of finite strain.

It differs from small strain in the force, which acts at the place of the deformed surface (`surface`); in the solid,
whose energy is that of F (`material`) in elements of two forms (`core`) around the contact, beyond which it is linear
(`block`); and in the surface tension, whose energy is that of the true area (`surface_area`).  The search of events
begins at those of small strain (`discretisation`, `events`), and `error_parts` has the error.
"""
