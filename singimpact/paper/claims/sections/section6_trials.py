"""Section 6: what is printed and what is corrected there, tried on the unfolded swans of two models."""

from fractions import Fraction

from singimpact.contact.points import tangency_points
from singimpact.contact.swans import swan_points_over_clearance
from singimpact.paper.claims.claim import Trial, Trials
from singimpact.paper.trials import true_orbits
from singimpact.paper.trials.true_sheet import swans

STEP = Fraction(1, 100)  # of the clearance, from c_0


def _side(printed: int, corrected: int) -> list[Trial]:
    """The side of c_0 on which a_c has two zeros near a negative swan."""
    rows = []
    for point in swans():
        centre = Fraction(float(point.model.replace().clearance.value))  # type: ignore[union-attr]
        counts = [len(tangency_points(point.model.replace(clearance=centre + sign * STEP))) for sign in (-1, 1)]
        side = {(2, 0): -1, (0, 2): 1}.get((counts[0], counts[1]), 0)
        text = f"{counts[0]} for c < c_0, {counts[1]} for c > c_0 = {float(centre):.8g}"
        says = [f"2 for c {'>' if sign > 0 else '<'} c_0" for sign in (printed, corrected)]
        rows.append(Trial(point.name, "zeros of a_c", text, says[0], says[1], side == printed, side == corrected))
    return rows


def _derivative(printed: int, corrected: int) -> list[Trial]:
    """The derivative of a_c0 that is to tell the sign of a swan: it must not vanish at tau_*."""
    rows = []
    for point in swans():
        values = [float(point.model.acceleration(point.tau, order=order)) for order in (printed, corrected)]
        says = [
            f"{'a' + order * chr(39)} = {value:.6g}" for order, value in zip((printed, corrected), values, strict=True)
        ]
        holds = [abs(value) > 1e-6 for value in values]
        rows.append(
            Trial(point.name, "a negative swan, told by its sign", "a sign", says[0], says[1], holds[0], holds[1])
        )
    return rows


def _signs(printed: tuple[int, int], corrected: tuple[int, int]) -> list[Trial]:
    """Signs of a' at the two zeros of a_c that a positive swan gives birth to."""
    rows = []
    for name, model in true_orbits.MODELS.items():
        swan = next(p for p in swan_points_over_clearance(model, (Fraction(-2), Fraction(2))) if p.kind == "positive")
        unfolded = model.replace(clearance=Fraction(swan.clearance) + STEP)
        near = [point for point in tangency_points(unfolded) if abs(point.tau - swan.tau) < 0.5]
        signs = tuple(1 if point.kind == "gamma" else -1 for point in near)
        holds = (signs == printed, signs == corrected)
        rows.append(Trial(name, "signs of a' at A and B", str(signs), str(printed), str(corrected), holds[0], holds[1]))
    return rows


TRIALS: dict[str, Trials] = {"s6-c-side": _side, "s6-a0-typo": _derivative, "s6p-AB": _signs}
