"""Equilibria in steady flow: Newton's method, relaxation and the search by both."""
