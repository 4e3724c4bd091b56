"""Measures of the boundaries of basins: the uncertainty exponent of pairs of states, and the entropy of boxes.

C. Grebogi, S. W. McDonald, E. Ott, J. A. Yorke, Phys. Lett. A 99 (1983) 415-418; A. Daza, A. Wagemakers, B. Georgeot,
D. Guery-Odelin, M. A. F. Sanjuan, Sci. Rep. 6 (2016) 31416.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.result import Result

# Uncertain pairs of a distance that is seen, and such distances that the fit needs
LEAST, FEWEST = 5, 3


@dataclass(frozen=True, repr=False)
class Uncertainty(Result):
    """The uncertainty exponent: the share of uncertain pairs is proportional to the distance to this power.

    Attributes
    ----------
    distances : of the two states of a pair, in sides of the window, shape (m,). pairs : whose states are both decided.
    uncertain : those of them that go to two attractors.
    exponent, error : 1 of a smooth boundary, less of a fractal one, whose dimension is 2 - exponent; and its standard
        error. Both are nan where `doubt` says why, and what to give.
    """

    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("distances", "pairs", "uncertain"), ("distances",)
    )
    distances: Array
    pairs: Array
    uncertain: Array
    exponent: float
    error: float
    doubt: str = ""

    def __repr__(self) -> str:
        shown = self.doubt or f"{self.exponent:.3g} +- {self.error:.1g}"
        return f"Uncertainty({shown}; {int(self.pairs.sum())} pairs at {self.distances.size} distances)"


def uncertainty_of(distances: Array, pairs: Array, uncertain: Array) -> Uncertainty:
    """The exponent of greatest likelihood, with binomial counts; its error grows where no power fits them.

    Parameters
    ----------
    distances, pairs, uncertain : as in `Uncertainty`, shape (m,).

    Examples
    --------
    >>> uncertainty_of(np.array([0.01, 0.02, 0.04]), np.full(3, 1000), np.array([20, 40, 80]))
    Uncertainty(1 +- 0.2; 3000 pairs at 3 distances)
    """
    counts = distances, pairs, uncertain
    seen = np.count_nonzero((uncertain >= LEAST) & (uncertain < pairs))
    if seen < FEWEST:
        words = f"no exponent: {seen} distances have {LEAST} uncertain pairs, give more pairs or other distances"
        return Uncertainty(*counts, np.nan, np.nan, words)
    terms, share = np.stack([np.ones(pairs.size), np.log(distances)]), (uncertain + 0.5) / (pairs + 1)
    for _ in range(50):  # Fisher's scoring
        weights = terms * (pairs * share / (1 - share))
        covariance = np.linalg.inv(weights @ terms.T)
        line = covariance @ weights @ (np.log(share) + (uncertain / np.maximum(pairs, 1) - share) / share)
        share = np.minimum(np.exp(line @ terms), 0.99)
    misfit = np.sum((uncertain - pairs * share) ** 2 / (np.maximum(pairs, 1) * share * (1 - share)))
    worse = max(float(misfit) / (pairs.size - 2), 1.0)
    return Uncertainty(*counts, float(line[1]), float(np.sqrt(covariance[1, 1] * worse)))


class BasinEntropy(NamedTuple):
    """Entropies of boxes of a grid of basins.

    Parameters
    ----------
    entropy : the mean over all boxes of -sum p ln p, p the shares of the attractors in a box. boundary : the mean over
        the boxes with several attractors; above ln 2 the boundary is fractal, below it may be; nan without such boxes.
    boxes, mixed : how many there are with decided states, and with several attractors.
    """

    entropy: float
    boundary: float
    boxes: int
    mixed: int


def entropy_of(codes: Array, decided: Array, box: int) -> BasinEntropy:
    """Basin entropy and boundary basin entropy.

    Parameters
    ----------
    codes : of the classes of a grid, shape (rows, columns). decided : of each class, whether its states count.
    box : states on the side of a box; what is left over at the ends of the grid is left out.

    Examples
    --------
    >>> entropy_of(np.array([[0, 0, 0, 1], [0, 0, 0, 1]]), np.array([True, True]), 2)
    BasinEntropy(entropy=0.34657359027997264, boundary=0.6931471805599453, boxes=2, mixed=1)
    """
    rows, columns = (size // box for size in codes.shape)
    cells = codes[: rows * box, : columns * box].reshape(rows, box, columns, box).swapaxes(1, 2)
    counts = np.array([(cells == code).sum(axis=(2, 3)).ravel() for code in np.flatnonzero(decided).tolist()])
    counts = counts[:, counts.sum(axis=0) > 0]
    shares = counts / counts.sum(axis=0)
    entropies = -np.sum(shares * np.log(np.where(shares > 0, shares, 1.0)), axis=0)
    mixed = entropies[(counts > 0).sum(axis=0) > 1]
    mean, between = (float(values.mean()) if values.size else np.nan for values in (entropies, mixed))
    return BasinEntropy(mean, between, entropies.size, mixed.size)
