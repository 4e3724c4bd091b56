"""Write `claims_stated.json` of the second program for claims, the list of what claims state, after a claim changed.

python tests/paper/certificates/stated_claims.py
"""

from __future__ import annotations

import json
from typing import Any

from singimpact.certificates import STATED, statement_of
from singimpact.paper import verify

COMMAND = "python tests/paper/certificates/stated_claims.py"


def stated() -> dict[str, Any]:
    """A digest of the words of each claim of the paper and beyond it."""
    verdicts = [verdict.as_dict() for ids in (False, True) for verdict in verify(beyond=ids)]
    return {"written by": COMMAND, "claims": {each["id"]: statement_of(each) for each in verdicts}}


if __name__ == "__main__":
    STATED.write_text(json.dumps(stated(), indent=1, sort_keys=True) + "\n", encoding="utf-8")
