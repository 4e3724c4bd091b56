"""True orbits and surfaces of several oscillators, on which printed and corrected statements are tried.

Not here: the statements and the verdicts (`paper.claims`), flights and orbits for a user (`flights`, `dynamics`).
Files: `true_orbits` (flights by scipy, chatter, return times), `surfaces` (V_c' on a grid of flights), `arcs`
(invariant arcs), `leaves` (of the stable foliation), `true_sheet` (v_c by differences at a point), `swans`,
`unfolded` (the universal model), `enclosed_swan` (that model in balls), `crosscheck` (v_c of `theory` against flights
in balls), `first_order` (feet of unfolded swans), `holder` (orbits beside gamma),
`universal_foot` (X for all r in balls), `loop_heights` (of W^s(X)), `onset` (the orbit born at a swan), `hertz`
(gamma where impacts lose a power of the speed).
"""
