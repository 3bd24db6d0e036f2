"""Broken inputs and broken data files, made from sound ones by rule and by seeded chance."""
