"""gamma of an analytic model proved before a contact point: it exists, is unique, and decides the fate of every launch.

Not here: its series in (tau, v) (`theory.gamma_series`), single thresholds (`dynamics.threshold`), the certificate
as a file and its check (`certificates`).
Files: `gravity` (the model as a ball under gravity: power series with a bound of its tail; times and places; launch
and landing speeds, in balls), `folded` (Taylor models in S and lambda), `nonlinear` (these speeds from the series of
v_c, with a bound of the rest), `lemmas` (drift, residual and cones, for a box of lambda), `after` (what comes after
the contact point), `proof` (`certified_gamma`).

The argument.  Launches are (S, l), S = -s at launch and l the ratio of landing to launch place; q = (1-l)/(1-L(S)).
Below l = L + Kl S^N the drift lemma makes q decrease: either q tends to 0, flights shorten by r and chatter completes
before tau_*, or l and S tend to (1, 0), where l = lambda by Descartes' rule, which contradicts it.  Above, q increases
until no impact comes before tau_*.  Both sets of launches are open on each fibre, so some launch is in neither; it
stays in the strip, and two that do would part in the cones.  So gamma is one Lipschitz graph within Kl S^N of L.
"""
