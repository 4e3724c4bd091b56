"""Germs of maps of the plane (u, t) -> (u, w(u, t)): recognised as fold, cusp, lips, beaks, swallowtail.

Not here: jets (`algebra`), the maps p and phi whose germs these are (`theory`), curves of singular points (`surface`).
The fold form of p with its witness is `theory.fold_form`, which has the jets of a contact as symbols.
"""
