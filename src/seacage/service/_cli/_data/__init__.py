"""Commands about what a service keeps: its samples, its tokens, and a backup of all."""
