"""Normal forms of p at a contact point, with the changes of source and target that reach them."""

from __future__ import annotations

from singimpact.contact.contact import contact_order
from singimpact.inputs import refuse
from singimpact.theory.fold_form import FoldForm, fold_form

HIGHEST = 10  # of the fold form for generic jets: seconds; each order takes about four times the one before


def normal_form(order: int = 4, at: str | int = "tangency") -> FoldForm:
    """The fold form of p at a tangency to total degree `order`: `.source`, `.outline` and what is left over.

    Parameters
    ----------
    order : int >= 3. at : "tangency" or 1; p is a fold at no other contact order.

    Examples
    --------
    >>> normal_form(order=3).normal
    (sigma, -eta**2*k)
    """
    if contact_order(at) != 1:
        raise refuse("at", at, "'tangency': p is folded there alone")
    if isinstance(order, bool) or not isinstance(order, int) or not 3 <= order <= HIGHEST:
        raise refuse("order", order, f"an integer from 3 to {HIGHEST}")
    return fold_form(order)
