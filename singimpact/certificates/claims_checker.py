"""The second program for claims: `python claims_checker.py DIR/*.json`, DIR of `singimpact verify --certificates DIR`.

This file stands alone but for two beside it, `claims_proofs.py` and the list `claims_stated.json`.  They import
python-flint and the standard library, and no file of the prover (`singimpact.algebra`).  `singimpact verify` runs
`claims_proofs` before it gives a verdict, and this program runs it on files.  A file holds when

    its title, printed and corrected statement and verdict are those of the claim in the list;
    its digest is that of its content, and its words agree: the effective verdict is no stronger than the argument and
    than the files that it rests on, "proved" uses no theorem and "proved modulo" names one;
    what is proved or certified has a certificate of its own, or names the files that it rests on, which hold;
    every certificate follows from its own numbers: polynomials are multiplied out, put into one another,
    differentiated and compared.

The statements of the list are LaTeX, which no program reads: that the certificates are what the statement needs is for
a reader to judge, by their sentences.

The kinds of certificates, and what shows each, are in `claims_proofs` beside it.
"""

import hashlib
import json
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

if __package__:
    from .claims_proofs import DIGITS, Refused, answered, check_certificate, fields_are, need
else:  # run as a file, it finds its own folder alone
    sys.path.insert(0, str(Path(__file__).parent))
    from claims_proofs import DIGITS, Refused, answered, check_certificate, fields_are, need  # type: ignore

SCHEMA = "singimpact claim 2"
STATED = Path(__file__).with_name("claims_stated.json")
BYTES = 4_000_000  # of a file
MODULO, IN_MODEL = "proved modulo", "proved in the model"
STRONGEST_FIRST = ("proved", MODULO, IN_MODEL, "certified", "argued", "formal", "supported", "cited", "open", "error")


def digest_of(content: Mapping[str, Any]) -> str:
    """A digest of all but itself."""
    rest = {name: part for name, part in content.items() if name != "digest"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()


STATEMENT = ("title", "printed", "corrected", "verdict", "corrected_kind")


def statement_of(content: Mapping[str, Any]) -> str:
    """A short digest of the words of a claim, as the list has it."""
    return digest_of({name: content[name] for name in STATEMENT})[:16]


def check_words(content: dict[str, Any]) -> None:
    """Nothing where the verdicts of a file agree: the effective one is no stronger than the argument and its theorems.

    Raises
    ------
    Refused : they do not, and why.
    """
    own = content["corrected_kind"] if content["verdict"] == "corrected" else content["verdict"]
    worth, modulo, below = content["effective"], content.get("modulo", []), content.get("effective_modulo", [])
    need(own in STRONGEST_FIRST and own != IN_MODEL, f"{own!r} is no verdict on an argument")
    need(worth in STRONGEST_FIRST, f"{worth!r} is no effective verdict")
    for names in (modulo, below):
        need(isinstance(names, list) and all(isinstance(name, str) and name for name in names), "a theorem has no name")
    need(set(modulo) <= set(below), "a theorem of the argument is missing from those of the effective verdict")
    for word, names in ((own, modulo), (worth, below)):
        need(word != "proved" or not names, f"proved, but modulo {', '.join(names)}")
        need(word != MODULO or names, f"{MODULO} no theorem")
    need(STRONGEST_FIRST.index(worth) >= STRONGEST_FIRST.index(own), f"{worth} is stronger than {own}")
    in_model = content.get("in_model") and own in ("proved", MODULO)
    need(not in_model or worth not in ("proved", MODULO), f"an argument about the model is not worth {worth}")


TEXTS, LISTS = (
    ("id", "section", "title", "printed", "verdict", "effective"),
    ("modulo", "effective_modulo", "certificates"),
)
OTHERS = ("corrected", "corrected_kind", "in_model", "rests_on", "schema", "digest")


def check_form(content: Any) -> None:
    """Nothing where a file has the fields of a claim, and a correction corrects."""
    need(
        isinstance(content, dict) and content.get("schema") == SCHEMA,
        f"only files of schema {SCHEMA!r} are checked here",
    )
    need(content.get("digest") == digest_of(content), "the digest is not that of the content: the file was changed")
    fields_are(content, {*TEXTS, *LISTS, *OTHERS})
    need(all(isinstance(content[name], str) and content[name] for name in TEXTS), "a text that is none")
    need(
        all(isinstance(content[name], list) for name in LISTS) and type(content["in_model"]) is bool,
        "a field of another type",
    )
    rests_on = content["rests_on"]
    need(
        isinstance(rests_on, dict) and all(isinstance(digest, str) for digest in rests_on.values()),
        "rests_on is no record",
    )
    corrected = content["verdict"] == "corrected"
    for name in ("corrected", "corrected_kind"):
        text = isinstance(content[name], str) and content[name]
        need(text if corrected else content[name] is None, f"{name} does not go with the verdict {content['verdict']}")
    need(content["corrected"] != content["printed"], "the correction is what is printed")


def check_supported(content: Mapping[str, Any], below: Mapping[str, Mapping[str, Any]]) -> None:
    """Nothing where what is proved rests on something, and is worth no more than that.

    Parameters
    ----------
    below : the files of the claims that it rests on, which hold, by id.
    """
    own = content["corrected_kind"] or content["verdict"]
    needs = own in ("proved", MODULO)
    need(
        not needs or content["certificates"] or content["rests_on"],
        f"{own}, without a certificate and without other files",
    )
    for name, digest in content["rests_on"].items():
        need(name in below, f"the file of {name}, on which it rests, is not given")
        need(below[name]["digest"] == digest, f"the file of {name} is another one")
        worth, other = (STRONGEST_FIRST.index(claim["effective"]) for claim in (content, below[name]))
        need(worth >= other, f"{content['effective']} is stronger than {name}, on which it rests")
        lost = set(below[name]["effective_modulo"]) - set(content["effective_modulo"])
        need(not lost, f"a theorem of {name} is missing: {min(lost, default='')}")


def check(content: Any, below: Mapping[str, Mapping[str, Any]] | None = None) -> int:
    """The number of certificates of a claim, when all hold, its words agree and so do the files that it rests on.

    Raises
    ------
    Refused : one does not hold, or the file was changed; and why.
    """
    with answered():
        check_form(content)
        check_words(content)
        stated = json.loads(STATED.read_text(encoding="utf-8"))["claims"]
        need(content["id"] in stated, f"{content['id']!r:.60} is no claim of the list")
        need(
            stated[content["id"]] == statement_of(content),
            f"the words or the verdict of {content['id']} are not those of the list",
        )
        check_supported(content, below or {})
        for n, certificate in enumerate(content["certificates"]):
            try:
                need(check_certificate(certificate) == certificate.get("says"), "it says nothing")
            except Refused as reason:
                raise Refused(f"certificate {n}: {reason}") from None
    return len(content["certificates"])


def read(path: Path) -> Any:
    """The content of a file, without numbers that are too long and names that occur twice."""

    def whole(text: str) -> int:
        need(len(text) < DIGITS, "a number that is too long")
        return int(text)

    def none(text: str) -> Any:
        raise Refused(f"{text[:20]} is no exact number")

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        need(len(dict(pairs)) == len(pairs), "a field occurs twice")
        return dict(pairs)

    need(not path.exists() or path.is_file(), "it is no file")
    with path.open("rb") as file:
        data = file.read(BYTES + 1)
    need(len(data) <= BYTES, f"the file has more than {BYTES} bytes")
    return json.loads(
        data.decode("utf-8"), parse_int=whole, parse_float=none, parse_constant=none, object_pairs_hook=once
    )


class Folder:
    """Files that were checked, each once; what a claim rests on is looked for beside its file."""

    def __init__(self) -> None:
        self.answers: dict[Path, tuple[Any, int] | Refused] = {}

    def held(self, path: Path, above: tuple[Path, ...] = ()) -> tuple[Any, int]:
        """The content of a file, and the number of its certificates."""
        if path not in self.answers:
            try:
                with answered():
                    need(path not in above and len(above) < 200, "files that rest on one another")
                    content = read(path)
                    names = content.get("rests_on") if isinstance(content, dict) else None
                    below = {name: self.held(path.with_name(file_of(name)), (*above, path))[0] for name in names or ()}
                    self.answers[path] = content, check(content, below)
            except Refused as reason:
                self.answers[path] = reason
        answer = self.answers[path]
        if isinstance(answer, Refused):
            raise Refused(f"{path.name}: {answer}" if above else str(answer))
        return answer


def file_of(name: str) -> str:
    """The name of the file of a claim."""
    need(re.fullmatch(r"[\w:.-]{1,80}", name, re.ASCII), f"{name[:60]!r} is no claim")
    return f"{name.replace(':', '_')}.json"


def main(paths: Sequence[str]) -> int:
    """0 where all files hold, else 1."""
    failed, folder = 0, Folder()
    for path in paths:
        try:
            content, count = folder.held(Path(path))
            rest = f"; rests on {', '.join(content['rests_on'])}" if content["rests_on"] else ""
            print(f"{path}: {f'{count} certificates hold' if count else 'has none of its own'}{rest}")
        except Refused as reason:
            print(f"{path}: refused: {reason}")
            failed = 1
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
