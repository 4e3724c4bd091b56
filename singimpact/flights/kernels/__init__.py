"""The inner loops of one flight: plain functions of numbers, that `flights.bind` compiles or runs on other numbers.

`state` (the named tuples that travel), `double_double`, `waves` (forcing phases and a_c at a launch), `roots` (the
first root of a polynomial), `linear` (closed form), `tables` (that closed form at multiples of a step), `tabulated`
(a flight through a table), `taylor` (a flight in Taylor steps), `steps` (how long a Taylor step may be), `recurrence`
(that of f and g, called at an address), `variational` (a flight with its derivatives), `refine` (a hit placed in
double-double), `hits` (a flight with its conditions), `orbits` (impact after impact), `chatter` (impacts until they
are summed up), `gamma` (velocities on gamma), `batch`, `batch_isolate`, `batch_refine` over `lanes` (many orbits in
lock-step), `layout` (where the numbers lie), `entries` (what Python calls).
Not here: anything that knows expressions, states as they are written, or statuses in words: the files of `flights`.
"""
