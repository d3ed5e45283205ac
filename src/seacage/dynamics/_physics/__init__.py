"""The physics, readable: loads, netting laws, wakes and the catenary."""
