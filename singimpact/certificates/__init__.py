"""Certified results as files, and the second program that checks them.

Not here: how a result is certified (`flights`), certificates of polynomial identities (`algebra`).
Files: `certificate` (writes and reads), `checker` (stands alone: it imports nothing of the package, and encloses the
motion again with its own code).
"""
