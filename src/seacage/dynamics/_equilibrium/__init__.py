"""Equilibria in steady flow: Newton's method, relaxation and the search by both."""

from seacage.dynamics._equilibrium._search import Equilibria, equilibria

__all__ = ["Equilibria", "equilibria"]
