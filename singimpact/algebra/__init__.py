"""Numbers on demand, rings, expression trees and jets: algebra that knows no mechanics.

Not here: germs of maps (`germs`), source code from an expression (`codegen`), anything with an oscillator in it.
`parsing` turns a user's text into a tree; a tree is evaluated over a ring, so one tree serves all kinds of number.
"""
