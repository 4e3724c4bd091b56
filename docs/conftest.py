"""Scripts of the gallery run when the site is built, and computed pages have no examples: neither is collected."""

collect_ignore_glob = ["gallery/*", "computed/*", "build/*"]
