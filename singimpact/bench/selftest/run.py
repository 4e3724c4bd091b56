"""All rows of a self-test in turn."""

from collections.abc import Callable
from time import process_time

from singimpact.bench.selftest import basin_pixels, batches, followed_orbits, responses, tangencies, truths
from singimpact.bench.selftest.draws import Flown, flown
from singimpact.bench.selftest.rows import Row, SelfTest
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.inputs import checked_keywords, refuse, takes_two_walls, whole
from singimpact.progress import ProgressLine

COMPARED: dict[str, Callable[[Flown], Row]] = {
    "flights forward and back": responses.round_trip,
    "small fixed steps": truths.fixed_steps,
    "more digits": truths.digits,
    "balls": truths.balls,
    "orbits": followed_orbits.orbits,
    "chatter limits": followed_orbits.limits,
    "D G": responses.derivatives,
    "rebounds": responses.rebounds,
    "basins": basin_pixels.row,
    "tangency points": tangencies.row,
    "batches": batches.lanes,
    "grazes": batches.grazes,
}


@checked_keywords
@takes_two_walls
def selftest(osc: ImpactOscillator, *, states: int = 1000, seed: int = 0) -> SelfTest:
    """Random states of a model, flown by the package and judged against independent computations.

    Parameters
    ----------
    osc : the model. With two walls the states are at the lower one, and orbits and basins go on from both.
    states : how many are drawn: phases over a period of g, or over [-10, 10]; velocities log-uniform over ten decades.
    seed : which states; the same seed draws the same ones.

    Returns
    -------
    SelfTest : prints as a table; `.wrong` is 0 where nothing is wrong, `.rows` has the counts and, for wrong states,
        the calls that repeat them.

    Raises
    ------
    InputError : osc is no ImpactOscillator, or states or seed is no whole number.

    Notes
    -----
    The rows are: flights forward and back; flights against fixed steps of order 8, against the balls of the program
    that checks certificates, and against `digits=20`; events of orbits (impacts, ends of chatter, lift-offs) and
    chatter limits; D G against differences of flights; rho; each state of an array longer than a batch; launches
    beside a graze; pixels of basins; signs of a_c beside tangency points. "Flown forward and back" compares the package
    with itself, and `digits=20` its two ways to fly. The second program shares nothing but the texts of the model; the
    truths of the others share with the package f, g and rho as expression trees, the period and the default horizon.

    A row starts no further state after 10 s of CPU time; states that are left are undecided.

    Examples
    --------
    >>> import singimpact as si
    >>> found = si.selftest(si.linear(2, "0.3", "0.5"), states=40)
    >>> found.wrong, found.rows[1].compared, found.rows[1].agree
    (0, 'against small fixed steps', 40)
    """
    if not isinstance(osc, ImpactOscillator):
        raise refuse("osc", osc, "an ImpactOscillator")
    count, chosen = whole("states", states, 1, 10**6), whole("seed", seed, 0, 2**63)
    begun = process_time()
    with ProgressLine() as line:
        line.show(0, len(COMPARED) + 1, "flights")
        drawn = flown(osc, count, chosen)
        rows = []
        for done, (name, compared) in enumerate(COMPARED.items()):
            line.show(done + 1, len(COMPARED) + 1, name)
            rows.append(compared(drawn))
    return SelfTest(repr(osc), tuple(rows), process_time() - begun)
