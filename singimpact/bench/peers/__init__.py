"""Programs that a user would choose instead, used as their own documentation shows.

They are imported when they are timed.

Files: `runge_kutta` (scipy), `taylor_events` (heyoka), `many_digits` (mpmath): a flight to its first event;
`last_terms` (the usual step rule of Taylor integrators); `impacts` (orbits, chatter, thresholds, by any of these);
`plain_series` and `lambdified` (sympy); `contours` (a zero set on a grid). A peer that is not there raises
`NotInstalled`.
"""
