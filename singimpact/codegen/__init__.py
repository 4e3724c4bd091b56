"""Source from mathematics: a vector field to the text of its Taylor recurrence, a text to a kernel on disk.

Not here: the expressions themselves (`algebra`), what a kernel is for (`flights`), frozen formulas (`generated`).
Files: `recurrence` (x'' = g - f to a recurrence), `kernels` (text compiled or run on mpf).
"""
