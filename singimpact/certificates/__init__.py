"""A result with its certificate as a file, and the second program that checks it.

`certificate` writes and reads them; `checker` stands alone, imports nothing of the package, and encloses the motion
again with its own code.  Certificates of polynomial identities are `algebra.certificates`.
"""
