"""Germs of maps of the plane (u, t) -> (u, w(u, t)): recognised as fold, cusp, lips, beaks, swallowtail.

Not here: jets (`algebra`), the maps p and phi whose germs these are (`theory`), curves of singular points (`surface`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "germ_forms": "normal_form recognised",
}
__getattr__ = names_of(__name__, _FILES)
