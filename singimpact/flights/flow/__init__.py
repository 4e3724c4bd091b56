"""How x moves between impacts: closed form (`closed_form`), Taylor series (`taylor`), scipy as a witness (`witness`).

Not here: where the obstacle is hit (`flights.march`), the recurrence (`codegen`).  The routes never import each other.
"""
