"""Programs that a user would choose instead, used as their own documentation shows.

They are imported when they are timed.
"""
