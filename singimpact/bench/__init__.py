"""Run time against error beside what a user would pick instead; stress sweeps; the reference cases as package data.

Not here: what is measured (`flights`, `surface`, `dynamics`), claims of the paper (`paper`), pictures (`scenes`).
Files: `problems` (the table of reference cases, read by the tests too), `data/` (its numbers); `groups/` (what
`singimpact bench` measures, one file a group), `measuring` (methods timed in turn and judged), `fresh` (in a process of
their own), `drawn` (states for every timed call), `compiled` (waiting for object code), `exponents` (how cost grows),
`first_commands` (CPU of a user's first commands, checked in CI), `report`, `plots`, `page` (the pages of the
documentation), `timed_sources` (of which commit a page is);
`states`, `truth/` (random states), `steep_families`, `steep_states`, `steep_balls`, `steep_digits`, `steep_cost` (those
with steep layers); `peers/`;
`stress/` (what `singimpact stress` runs); `selftest/` (random states of a user's own model, `singimpact selftest`).
"""
