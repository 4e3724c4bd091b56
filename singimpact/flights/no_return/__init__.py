"""Flights that are proved never to return, or not before the horizon: one file a kind of model.

Files: `linear` (bounds on free motion and waves), `polynomial` (f cannot turn a rising mass back), `averaged` (too fast
for bounded waves of f and g), `barrier` (strong damping keeps it up).
Not here: flights that touch (`closing`), flights that leave the range of numbers (`causes`).
"""
