"""Commands about what a service keeps: its samples, tokens and twins, and a backup of all."""
