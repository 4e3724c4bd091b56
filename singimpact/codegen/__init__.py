"""Source from mathematics: an expression to source text, a vector field to its Taylor recurrence, text to a kernel on disk.

Not here: the expressions themselves (`algebra`), what a kernel is used for (`flights`), formulas frozen as files (`generated`).
Files: `recurrence` (x'' = g - f to a recurrence), `kernels` (text to a file in the cache folder, compiled or run on mpf).
"""
