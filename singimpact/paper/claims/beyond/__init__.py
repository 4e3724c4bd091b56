"""Claims that the paper does not have, apart from its own: `BEYOND` is file -> the names of its Python file.

Not here: claims of the paper (`claims.sections`). None is printed anywhere, so none is corrected; mutants stand beside.
"""

from singimpact.handed_on import names_of

FILES = (
    "cascade",
    "horseshoe",
    "every_order",
    "gauge",
    "first_order",
    "holder",
    "foot",
    "order_three",
    "loops",
    "onset",
    "events_harmonic",
    "gamma",
    "hertz",
)
BEYOND = {file: names_of(__name__, {file: "CLAIMS"}) for file in FILES}
