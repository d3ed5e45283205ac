"""The predicted net for those who move along it: clearance of points and paths, inspection."""
