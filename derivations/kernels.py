"""Write the object code of the kernels that comes with the package: `python derivations/kernels.py`.

It takes about two minutes of CPU, and is needed after every change of the kernels or of what compiles them: until then
they are compiled on each machine once more.
"""

from __future__ import annotations

import json
import lzma

from singimpact.flights.shipped import FOLDER, INDEX, index_of, objects, texts
from singimpact.store import folder, written


def main() -> None:
    """Write them all; what was there before is removed."""
    contents = objects(texts())
    folder(FOLDER)
    for old in FOLDER.glob("*.xz"):
        old.unlink()
    files = {f"{name}.xz": lzma.compress(content, preset=9 | lzma.PRESET_EXTREME) for name, content in contents.items()}
    files[INDEX] = (json.dumps(index_of(contents), indent=1) + "\n").encode()
    for name, content in files.items():
        with written(FOLDER / name) as draft:
            draft.write_bytes(content)
    print(f"{len(contents)} files of object code, {sum(map(len, files.values()))} bytes")


if __name__ == "__main__":
    main()
