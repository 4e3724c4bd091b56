"""The gallery: pictures of its scripts that are no figures of pyplot, and links to them from the reference."""

import inspect
import json
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

USES = "computed/gallery_uses"
"""Where sphinx-gallery writes which script uses which name."""
MOST = 4
"""Thumbnails under one entry of the reference."""
FIRST = ("plot_own_model.py", "plot_orbit.py", "plot_animation.py", "plot_bifurcation.py", "plot_branch.py")
"""The first scripts of their sections."""
WRITTEN = (".csv", ".gif", ".pdf", ".png")
"""Endings of files that scripts write beside themselves."""


def held_pictures(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Markup for the animations, and figures that pyplot does not have, that variables of a script hold."""
    from matplotlib.figure import Figure
    from sphinx_gallery.scrapers import figure_rst

    from singimpact.scenes.orbit_picture import OrbitAnimation

    held = {id(thing): thing for thing in block_vars["example_globals"].values()}
    pictures = []
    for thing in held.values():
        if isinstance(thing, OrbitAnimation):
            ending, write = ".gif", thing.save
        elif isinstance(thing, Figure) and getattr(thing, "number", None) is None:
            ending, write = ".png", thing.savefig
        else:
            continue
        picture = Path(next(block_vars["image_path_iterator"])).with_suffix(ending)
        write(picture)
        pictures.append(picture)
    return figure_rst(pictures, gallery_conf["src_dir"]) if pictures else ""


def remove_written(gallery_conf: dict[str, Any], name: str | None, when: str) -> None:
    """Close the figures of others before a script, and remove the files that it has written beside itself after it."""
    import matplotlib.pyplot as plt

    plt.close("all")
    for file in Path(gallery_conf["src_dir"], gallery_conf["examples_dirs"]).glob("*/*") if when == "after" else ():
        if file.suffix in WRITTEN:
            file.unlink()


def in_order(name: str) -> tuple[int, str]:
    """The place of a script in its section: those that a newcomer meets first, then the others by name."""
    return FIRST.index(name) if name in FIRST else len(FIRST), name


def thing_of(path: str) -> Any:
    """The object of a dotted path, or None."""
    parts = path.split(".")
    for length in range(len(parts), 0, -1):
        try:
            thing = import_module(".".join(parts[:length]))
        except ModuleNotFoundError:
            continue
        for name in parts[length:]:
            thing = getattr(thing, name, None)
        return thing
    return None


def names_of(thing: Any) -> Iterator[int]:
    """Identities of an object: its own, and that of the method of the model that calls it."""
    from singimpact import ImpactOscillator
    from singimpact.handed_on import Study

    yield id(thing)
    name, home = getattr(thing, "__name__", ""), getattr(thing, "__module__", "")
    method = vars(ImpactOscillator).get(name)
    series = home.startswith("singimpact.theory")  # si.theory.chatter_limit is another function than the method
    if inspect.isfunction(thing) and method is not None and not isinstance(method, Study) and not series:
        yield id(method)


def scripts_by_thing(uses: Path) -> dict[int, set[str]]:
    """Scripts of the gallery, as paths from the folder of the documentation, by identities of what they use."""
    found: dict[int, set[str]] = {}
    for path, scripts in json.loads(uses.read_text(encoding="utf-8")).items():
        thing = thing_of(path)
        if thing is None:
            continue
        for name in names_of(thing):
            for script, folder, *_ in scripts:
                found.setdefault(name, set()).add(f"{Path(folder, script)}")
    return found


def add_examples(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Thumbnails of the scripts that use a function, a method or a class, below its docstring."""
    if what not in ("function", "method", "class"):
        return
    uses = Path(app.srcdir) / USES / "backreferences_all.json"
    if not hasattr(app, "scripts_by_thing"):
        app.scripts_by_thing = scripts_by_thing(uses)
    scripts = sorted(set().union(*(app.scripts_by_thing.get(each, set()) for each in names_of(thing))))
    if not scripts:
        return
    app.env.note_dependency(str(uses))
    root = Path(app.srcdir)
    paths = [(root / script).resolve().relative_to(root.resolve()).as_posix() for script in scripts[:MOST]]
    title = "Examples with this class" if what == "class" else "Examples with this function"
    lines += ["", f".. rubric:: {title}", "", f".. minigallery:: {' '.join(paths)}", ""]


def setup(app: Any) -> dict[str, Any]:
    """After napoleon has read the sections."""
    app.connect("autodoc-process-docstring", add_examples, priority=900)
    return {"parallel_read_safe": False}
