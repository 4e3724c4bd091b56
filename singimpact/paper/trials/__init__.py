"""True orbits and surfaces of several oscillators, on which printed and corrected statements are tried.

Not here: the statements and the verdicts (`paper.claims`), flights and orbits for a user (`flights`, `dynamics`).
"""
