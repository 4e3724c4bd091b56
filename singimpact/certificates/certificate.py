"""`certify` and `read_certificate`: a certified result as a file that the second program accepts."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from singimpact.certificates.checker import PARTS, SCHEMA, digest_of
from singimpact.flights.results import CertifiedImpact, Flight
from singimpact.inputs import InputError, refuse
from singimpact.store import write_text

CHECKER = Path(__file__).with_name("checker.py")
"""The second program: `python checker.py FILE.json`."""


@dataclass(frozen=True)
class Certificate:
    """What is certified, as text that the second program reads.

    Attributes
    ----------
    content : schema, statement, model, launch, and the numbers with their radii, all as text; and a digest of these.
    """

    content: dict[str, Any]

    @property
    def text(self) -> str:
        """The certificate as JSON."""
        return json.dumps(self.content, indent=2, ensure_ascii=False) + "\n"

    def save(self, path: Any) -> None:
        """Write the certificate to a file."""
        write_text(path, self.text)

    def check(self) -> None:
        """Let the second program enclose the motion again, in a process of its own.

        Raises
        ------
        InputError : it does not accept the certificate; its reason.
        """
        with TemporaryDirectory() as folder:
            path = Path(folder) / "certificate.json"
            path.write_text(self.text, encoding="utf-8")
            done = subprocess.run(
                [sys.executable, "-I", str(CHECKER), str(path)], capture_output=True, text=True, check=False
            )
        if done.returncode:
            reason = (done.stdout or done.stderr).strip().partition("refused: ")[2] or done.stderr.strip()
            raise InputError(f"the certificate is refused: {reason}")

    def __repr__(self) -> str:
        launch = self.content["launch"]
        shown = ", ".join(f"{name} = {self.content[name]['value']}" for name in PARTS[2:])
        return f"<certificate of the {self.content['statement']} from ({launch['tau']}, {launch['v']}): {shown}>"


def certify(result: Any) -> Certificate:
    """The certificate of a certified result.

    Parameters
    ----------
    result : of `osc.impact_map` or `osc.first_hit` for one state with `digits`; or its `.certified`.

    Returns
    -------
    Certificate : `.save("file.json")` writes it, `.check()` lets the second program check it.

    Raises
    ------
    InputError : another kind of result; one that is not certified, with the reason.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> found = certify(linear("2.8", 0, "0.8").impact_map("0.9", "0.3", digits=20))
    >>> found
    <certificate of the first impact from (0.9, 0.3): tau = 1.533939680393141763696, v = 0.2033385063288414561421>
    >>> found.check()
    """
    impact = result.certified if isinstance(result, Flight) else result
    if isinstance(result, Flight) and impact is None:
        why = "; ".join(result.notes.values()) or "it has no digits=: ask for some"
        raise InputError(f"the result is not certified: {why}")
    if not isinstance(impact, CertifiedImpact) or impact.oscillator is None:
        raise refuse("result", result, "what osc.impact_map(tau, v, digits=30) gives for one state")
    numbers = {name: getattr(impact, name).as_dict() for name in PARTS}
    launch = {name: str(part) for name, part in zip(("tau", "v"), impact.launch, strict=True)}
    content = {"schema": SCHEMA, "statement": "first impact", "model": impact.oscillator.to_dict(), "launch": launch}
    content |= numbers
    return Certificate({**content, "digest": digest_of(content)})


def read_certificate(path: Any) -> Certificate:
    """A certificate from a file, once the second program has accepted it.

    Raises
    ------
    InputError : no such file, no certificate; or one that is refused, with the reason.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> with TemporaryDirectory() as folder:
    ...     certify(linear("2.8", 0, "0.8").impact_map("0.9", "0.3", digits=20)).save(f"{folder}/impact.json")
    ...     print(read_certificate(f"{folder}/impact.json").content["v"]["radius"])
    2.05e-22
    """
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    except ValueError:
        raise InputError(f"{path} is no certificate: it is not JSON") from None
    found = Certificate(content if isinstance(content, dict) else {})
    found.check()
    return found
