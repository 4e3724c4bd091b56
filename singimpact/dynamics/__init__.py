"""Flights after flights: orbits, sticking, complete chatter.

Not here: one flight (`flights`), power series of the chatter's end (`theory`), pictures of an orbit (`scenes`).
Files: `orbit` (impacts, rest and chatter in order), `rest` (when a mass lifts off), `chatter` (when impacts end),
`completion` (its map), `threshold` (the velocity between complete and incomplete chatter), `periodic`.
"""
