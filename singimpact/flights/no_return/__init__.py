"""Flights that are proved never to return, or not before the horizon: one file a kind of model."""
