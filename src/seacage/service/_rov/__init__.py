"""How near a vehicle is to the net, in a pilot's frames and files."""
