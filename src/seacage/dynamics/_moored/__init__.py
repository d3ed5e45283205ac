"""A cage on its mooring: pretension, anchor lines, more detail and stable masses."""
