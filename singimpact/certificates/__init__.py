"""Certified results as files, and the second programs that check them and the proofs of claims.

Not here: how a result is certified (`flights`), how certificates of polynomials are made and first checked (`algebra`).
Files: `certificate` (writes and reads them), `checker` (a folder that stands alone: it imports nothing of the package,
and encloses the motion again with its own code), `claims_checker` (stands alone too: it checks what claims rest on,
with the polynomials and rules of `claims_proofs` beside it, and the words of `claims_stated.json`).
"""
