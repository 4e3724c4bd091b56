"""Run time against error beside what a user would pick instead; stress sweeps; the reference cases as package data.

Not here: what is measured (`flights`, `surface`, `dynamics`), claims of the paper (`claims`), pictures (`scenes`).
Files: `problems` (the table of reference cases, read by the tests too), `data/` (its numbers); `map_speed`,
`grid_speed`, `warm_start`, `series` (what `singimpact bench` measures); `states`, `truth/` (random states); `peers/`.
"""
